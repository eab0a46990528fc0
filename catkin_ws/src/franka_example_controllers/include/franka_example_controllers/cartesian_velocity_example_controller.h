// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_example_controllers/pi.h>
#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Moves the end effector back and forth along a line with a downward slope of 45 degrees: 4 s
/// forth, 4 s back, 0.05 m/s at most.
///
/// Parameter in the controller's namespace: `arm_id`. stopping() keeps the last velocity: a jump to
/// zero would be a discontinuity; the robot brakes by itself.
class CartesianVelocityExampleController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaVelocityCartesianInterface, franka_hw::FrankaStateInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong, the robot
  /// lacks a handle or is not at the start of the motion.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "CartesianVelocityExampleController";
  static constexpr double kCycle = 4.0;         // [s]
  static constexpr double kMaxVelocity = 0.05;  // [m/s]
  static constexpr double kSlope = kPi / 4.0;   // [rad]

  std::unique_ptr<franka_hw::FrankaCartesianVelocityHandle> velocity_handle_;
  double elapsed_{0.0};  // [s]
};

}  // namespace franka_example_controllers
