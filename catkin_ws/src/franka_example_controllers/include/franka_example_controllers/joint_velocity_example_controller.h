// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Moves all joints back and forth by smooth velocities: 8 s forth, 8 s back, 0.1 rad/s at most.
///
/// Parameters in the controller's namespace: `arm_id`, `joint_names` (seven). stopping() keeps the
/// last velocity: a jump to zero would be a discontinuity; the robot brakes by itself.
class JointVelocityExampleController
    : public controller_interface::MultiInterfaceController<
          hardware_interface::VelocityJointInterface, franka_hw::FrankaStateInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong, the robot
  /// lacks a handle or is not at the start of the motion.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "JointVelocityExampleController";
  static constexpr double kCycle = 8.0;        // [s]
  static constexpr double kMaxVelocity = 0.1;  // [rad/s]

  std::vector<hardware_interface::JointHandle> joint_handles_;
  double elapsed_{0.0};  // [s]
};

}  // namespace franka_example_controllers
