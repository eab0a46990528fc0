// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller.h>
#include <franka_hw/trigger_rate.h>
#include <franka_sim/robot/hands/gripper_unit.h>
#include <franka_sim_mujoco/gripper_actions.h>
#include <franka_sim_mujoco/gripper_mailbox.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_publisher.h>
#include <sensor_msgs/JointState.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

namespace franka_sim_mujoco {

/// The Franka hand in simulation: a controller of the two finger joints' efforts with the actions
/// of the real gripper node and its topic joint_states (30 Hz). GripperUnit implements the
/// behavior, this class the ROS interface. Parameters in the controller's namespace: see the
/// package's documentation (manual, FrankaGripperSim).
class FrankaGripperSim
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  bool init(hardware_interface::EffortJointInterface* hw, ros::NodeHandle& node) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;
  void stopping(const ros::Time& time) override;

 private:
  franka_sim::HandMeasurement measure() const;
  void publish(const ros::Time& time);

  std::array<hardware_interface::JointHandle, 2> fingers_;
  std::optional<franka_sim::GripperUnit> unit_;
  GripperMailbox mailbox_;
  GripperView view_;
  std::optional<franka_hw::TriggerRate> publish_rate_;
  std::unique_ptr<realtime_tools::RealtimePublisher<sensor_msgs::JointState>> joint_states_;
  std::unique_ptr<GripperActions> actions_;  ///< last: its threads use the members above
};

}  // namespace franka_sim_mujoco
