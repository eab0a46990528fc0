// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control_base.h>
#include <franka/robot.h>

#include <memory>

/// @file
/// Common base of motions driven by the program.

namespace franka {

/// Reads states and refuses all forms of command; each kind of motion allows its own form.
class ActiveControl : public ActiveControlBase {
 public:
  /// Stops the robot unless the motion has ended. Never throws; takes at most as long as
  /// Robot::stop.
  ~ActiveControl() override;

  std::pair<RobotState, Duration> readOnce() override;
  void writeOnce(const Torques& control_input) override;
  void writeOnce(const JointPositions& motion_generator_input,
                 const std::optional<const Torques>& control_input) override;
  void writeOnce(const JointVelocities& motion_generator_input,
                 const std::optional<const Torques>& control_input) override;
  void writeOnce(const CartesianPose& motion_generator_input,
                 const std::optional<const Torques>& control_input) override;
  void writeOnce(const CartesianVelocities& motion_generator_input,
                 const std::optional<const Torques>& control_input) override;
  void writeOnce(const JointPositions& motion_generator_input) override;
  void writeOnce(const JointVelocities& motion_generator_input) override;
  void writeOnce(const CartesianPose& motion_generator_input) override;
  void writeOnce(const CartesianVelocities& motion_generator_input) override;

 protected:
  /// The motion on the robot. Shares the connection, so that it may outlive the Robot.
  class Motion;
  explicit ActiveControl(std::unique_ptr<Motion> motion);

  std::unique_ptr<Motion> motion_;

 private:
  friend class Robot;
};

}  // namespace franka
