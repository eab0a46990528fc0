// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>

/// @file
/// The return types of control callbacks, which run once a millisecond. All types are values.
/// Real-time safe. Thread-safe.

namespace franka {

/// The robot's own controller that follows a motion generator.
enum class ControllerMode {
  kJointImpedance,     ///< springs between q and q_d
  kCartesianImpedance  ///< springs between O_T_EE and O_T_EE_d
};

/// Policy if the calling thread cannot get realtime priority.
enum class RealtimeConfig {
  kEnforce,  ///< refuse to control the robot (simulated ones: see Robot)
  kIgnore    ///< continue without
};

/// Base of every command: whether the motion ends with it.
struct Finishable {
  bool motion_finished = false;  ///< set by MotionFinished
};

/// Joint torques without gravity and friction.
class Torques : public Finishable {
 public:
  /// @param torques tau_J_d [Nm].
  Torques(const std::array<double, 7>& torques) noexcept;
  /// @param torques seven values [Nm]. @throws std::invalid_argument for any other number of
  /// values.
  Torques(std::initializer_list<double> torques);

  std::array<double, 7> tau_J{};  ///< desired torques [Nm]
};

/// Joint positions.
class JointPositions : public Finishable {
 public:
  /// @param joint_positions q_c [rad].
  JointPositions(const std::array<double, 7>& joint_positions) noexcept;
  /// @param joint_positions seven values [rad]. @throws std::invalid_argument for any other number.
  JointPositions(std::initializer_list<double> joint_positions);

  std::array<double, 7> q{};  ///< desired positions [rad]
};

/// Joint velocities.
class JointVelocities : public Finishable {
 public:
  /// @param joint_velocities dq_c [rad/s].
  JointVelocities(const std::array<double, 7>& joint_velocities) noexcept;
  /// @param joint_velocities seven values [rad/s]. @throws std::invalid_argument for any other
  /// number.
  JointVelocities(std::initializer_list<double> joint_velocities);

  std::array<double, 7> dq{};  ///< desired velocities [rad/s]
};

/// Pose of the end effector in O, optionally with the elbow.
class CartesianPose : public Finishable {
 public:
  /// @param cartesian_pose O_T_EE_c, 4x4 column-major.
  CartesianPose(const std::array<double, 16>& cartesian_pose) noexcept;
  /// @param cartesian_pose O_T_EE_c, 4x4 column-major.
  /// @param elbow position of joint 3 [rad] and sign of joint 4 (+1 or -1).
  CartesianPose(const std::array<double, 16>& cartesian_pose,
                const std::array<double, 2>& elbow) noexcept;
  /// @param cartesian_pose 16 values. @throws std::invalid_argument for any other number.
  CartesianPose(std::initializer_list<double> cartesian_pose);
  /// @param cartesian_pose 16 values. @param elbow two values.
  /// @throws std::invalid_argument for any other numbers.
  CartesianPose(std::initializer_list<double> cartesian_pose, std::initializer_list<double> elbow);

  std::array<double, 16> O_T_EE{};  ///< desired pose, 4x4 column-major
  std::array<double, 2> elbow{};    ///< joint 3 [rad], sign of joint 4; zeros: not commanded

  /// Whether an elbow is commanded: it is unless both values are zero.
  bool hasElbow() const noexcept;
};

/// Twist of the end effector in O, optionally with the elbow.
class CartesianVelocities : public Finishable {
 public:
  /// @param cartesian_velocities O_dP_EE_c: linear [m/s], then angular [rad/s].
  CartesianVelocities(const std::array<double, 6>& cartesian_velocities) noexcept;
  /// @param cartesian_velocities O_dP_EE_c: linear [m/s], then angular [rad/s].
  /// @param elbow position of joint 3 [rad] and sign of joint 4 (+1 or -1).
  CartesianVelocities(const std::array<double, 6>& cartesian_velocities,
                      const std::array<double, 2>& elbow) noexcept;
  /// @param cartesian_velocities six values. @throws std::invalid_argument for any other number.
  CartesianVelocities(std::initializer_list<double> cartesian_velocities);
  /// @param cartesian_velocities six values. @param elbow two values.
  /// @throws std::invalid_argument for any other numbers.
  CartesianVelocities(std::initializer_list<double> cartesian_velocities,
                      std::initializer_list<double> elbow);

  std::array<double, 6> O_dP_EE{};  ///< desired twist: linear [m/s], angular [rad/s]
  std::array<double, 2> elbow{};    ///< joint 3 [rad], sign of joint 4; zeros: not commanded

  /// Whether an elbow is commanded: it is unless both values are zero.
  bool hasElbow() const noexcept;
};

/// The same command, marked as the last one of its motion.
inline Torques MotionFinished(Torques command) noexcept {
  command.motion_finished = true;
  return command;
}
/// @copydoc MotionFinished(Torques)
inline JointPositions MotionFinished(JointPositions command) noexcept {
  command.motion_finished = true;
  return command;
}
/// @copydoc MotionFinished(Torques)
inline JointVelocities MotionFinished(JointVelocities command) noexcept {
  command.motion_finished = true;
  return command;
}
/// @copydoc MotionFinished(Torques)
inline CartesianPose MotionFinished(CartesianPose command) noexcept {
  command.motion_finished = true;
  return command;
}
/// @copydoc MotionFinished(Torques)
inline CartesianVelocities MotionFinished(CartesianVelocities command) noexcept {
  command.motion_finished = true;
  return command;
}

}  // namespace franka
