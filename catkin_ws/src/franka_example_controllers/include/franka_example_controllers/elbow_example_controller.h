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

/// Moves the elbow by up to 0.2 pi rad while the end effector stays at its pose.
///
/// Parameter in the controller's namespace: `arm_id`.
class ElbowExampleController
    : public controller_interface::MultiInterfaceController<franka_hw::FrankaPoseCartesianInterface,
                                                            franka_hw::FrankaStateInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong, the robot
  /// lacks a handle or is not at the start of the motion.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "ElbowExampleController";
  static constexpr double kCycle = 10.0;       // [s]
  static constexpr double kSwing = kPi / 5.0;  // of joint 3 there and back [rad]

  std::unique_ptr<franka_hw::FrankaCartesianPoseHandle> pose_handle_;
  std::array<double, 16> O_T_EE_start_{};  // 4x4 column-major
  std::array<double, 2> elbow_start_{};    // joint 3 [rad], sign of joint 4
  double elapsed_{0.0};                    // [s]
};

}  // namespace franka_example_controllers
