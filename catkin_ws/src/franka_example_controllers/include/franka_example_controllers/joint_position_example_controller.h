// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_example_controllers/pi.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Moves all joints by up to 0.04 pi rad from their start positions, the fifth in the opposite
/// direction, with a period of 10 s.
///
/// Parameter in the controller's namespace: `joint_names` (seven).
class JointPositionExampleController : public controller_interface::MultiInterfaceController<
                                           hardware_interface::PositionJointInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong, the robot
  /// lacks a handle or is not at the start of the motion.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "JointPositionExampleController";
  static constexpr double kCycle = 10.0;             // [s]
  static constexpr double kSwing = 0.2 * kPi / 8.0;  // of each joint there and back [rad]
  static constexpr std::size_t kOpposite = 4;  // the fifth joint moves in the opposite direction

  std::vector<hardware_interface::JointHandle> joint_handles_;
  std::array<double, 7> q_start_{};  // [rad]
  double elapsed_{0.0};              // [s]
};

}  // namespace franka_example_controllers
