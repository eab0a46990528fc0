// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_example_controllers/gentle_stop.h>
#include <franka_hw/control_mode.h>
#include <franka_hw/franka_cartesian_command_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// A command for one cycle; only claimed values are used.
struct ArmCommand {
  std::array<double, 7> joints{};  ///< positions [rad] or velocities [rad/s]
  std::array<double, 16> pose{};   ///< O_T_EE, column-major
  std::array<double, 6> twist{};   ///< of EE in O [m/s, rad/s]
  std::array<double, 2> elbow{};   ///< (q3 [rad], sign of q4); zeros leave it free
  std::array<double, 7> effort{};  ///< without gravity [Nm]
};

/// Commands one arm through any allowed combination of interfaces, and can bring it to rest from
/// any last command. Called by one thread. Real-time safe. Exception: take().
class ArmCommander {
 public:
  /// Gets and claims the handles of a mode.
  /// @throws hardware_interface::HardwareInterfaceException if the robot lacks one
  void take(hardware_interface::RobotHW* robot_hw, const std::string& arm_id,
            const std::vector<std::string>& joint_names, franka_hw::ControlMode mode);

  /// Commands the arm's desired position, and resets the history.
  void holdStill(const franka::RobotState& state);
  /// Passes a command. @param period since the last one [s]
  void command(const ArmCommand& command, double period);

  /// From now on rest() brings the arm to rest.
  void beginRest();
  /// One cycle of coming to rest: motions end along cubics without a jump of velocity or
  /// acceleration, torques become damping, changed by at most 1 Nm per cycle. @returns true once
  /// the arm rests (or two seconds later); call it until the controller stops
  bool rest(const franka::RobotState& state, double period);

 private:
  void send(const ArmCommand& command);
  void noteCartesian(const ArmCommand& command, double period);
  void restMotion(ArmCommand& command, double period) const;
  std::array<double, 7> damping(const franka::RobotState& state) const;

  franka_hw::ControlMode mode_{franka_hw::ControlMode::None};
  std::vector<hardware_interface::JointHandle> motion_handles_;  // positions or velocities
  std::vector<hardware_interface::JointHandle> effort_handles_;
  std::unique_ptr<franka_hw::FrankaCartesianPoseHandle> pose_handle_;
  std::unique_ptr<franka_hw::FrankaCartesianVelocityHandle> twist_handle_;

  ArmCommand last_;
  Differences<7> joints_;
  Differences<6> twist_;  // commanded, or derived from the commanded poses
  Differences<1> elbow_;

  double resting_{0.0};  // [s] since beginRest
  GentleStop<7> joint_stop_;
  GentleStop<6> twist_stop_;
  GentleStop<1> elbow_stop_;
};

}  // namespace franka_example_controllers
