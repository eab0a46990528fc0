// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <franka/duration.h>
#include <franka/robot_state.h>

#include <optional>
#include <utility>

/// @file
/// A motion that the program drives itself, one call a millisecond.

namespace franka {

/// A running motion without callbacks: read a state, answer it, and so on.
///
///   auto motion = robot.startTorqueControl();
///   while (!finished) {
///     auto [state, period] = motion->readOnce();
///     motion->writeOnce(torques);
///   }
///
/// Commands are sent unchanged: no filter, no rate limiter. A command with `motion_finished` set
/// ends the motion; destroying the object earlier stops the robot. Until then the Robot is busy:
/// other motions and reads throw InvalidOperationException. Called by one thread at a time. Without
/// a state for a second readOnce throws a NetworkException.
class ActiveControlBase {
 public:
  virtual ~ActiveControlBase() = default;
  ActiveControlBase(const ActiveControlBase&) = delete;
  ActiveControlBase& operator=(const ActiveControlBase&) = delete;

  /// Waits for the next state. Real-time safe.
  /// @returns the state, and the time since the state of the call before [ms]; 0 the first time.
  /// @throws ControlException if the motion was aborted or has ended.
  /// @throws NetworkException if the connection is lost.
  virtual std::pair<RobotState, Duration> readOnce() = 0;

  /// Answers the last state. The form must match the start of the motion; other forms throw
  /// ControlException. Real-time safe.
  /// @param control_input torques [Nm].
  /// @throws ControlException if the motion was aborted or has ended.
  /// @throws NetworkException if the connection is lost.
  /// @throws std::invalid_argument if a value is not finite, a matrix no transformation, or an
  /// elbow's sign neither +1 nor -1.
  virtual void writeOnce(const Torques& control_input) = 0;
  /// @copydoc writeOnce(const Torques&)
  /// @param motion_generator_input joint positions [rad].
  virtual void writeOnce(const JointPositions& motion_generator_input,
                         const std::optional<const Torques>& control_input) = 0;
  /// @copydoc writeOnce(const Torques&)
  /// @param motion_generator_input joint velocities [rad/s].
  virtual void writeOnce(const JointVelocities& motion_generator_input,
                         const std::optional<const Torques>& control_input) = 0;
  /// @copydoc writeOnce(const Torques&)
  /// @param motion_generator_input pose of EE in O.
  virtual void writeOnce(const CartesianPose& motion_generator_input,
                         const std::optional<const Torques>& control_input) = 0;
  /// @copydoc writeOnce(const Torques&)
  /// @param motion_generator_input twist of EE in O [m/s, rad/s].
  virtual void writeOnce(const CartesianVelocities& motion_generator_input,
                         const std::optional<const Torques>& control_input) = 0;
  /// As writeOnce(const Torques&). @param motion_generator_input joint positions [rad].
  virtual void writeOnce(const JointPositions& motion_generator_input) = 0;
  /// As writeOnce(const Torques&). @param motion_generator_input joint velocities [rad/s].
  virtual void writeOnce(const JointVelocities& motion_generator_input) = 0;
  /// As writeOnce(const Torques&). @param motion_generator_input pose of EE in O.
  virtual void writeOnce(const CartesianPose& motion_generator_input) = 0;
  /// As writeOnce(const Torques&). @param motion_generator_input twist of EE in O [m/s, rad/s].
  virtual void writeOnce(const CartesianVelocities& motion_generator_input) = 0;

 protected:
  ActiveControlBase() = default;
};

}  // namespace franka
