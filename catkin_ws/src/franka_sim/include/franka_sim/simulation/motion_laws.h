// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <array>

/// @file
/// Torque controllers that run at 1 kHz below a slow program, which gives them targets. They are
/// clients of the robot: their torques pass the robot's limits and reflexes. Called by one thread.
/// Real-time safe.

namespace franka_sim {

/// How a target moves: from rest to rest (smoothStep), or at constant speed, for targets that
/// follow each other.
enum class TargetMotion { kSmooth, kLinear };

/// A spring and damper at every joint (JointImpedance), whose target moves.
class JointLaw {
 public:
  /// Begins at the state's desired position.
  explicit JointLaw(const franka_core::RobotState& state) noexcept;

  /// @param q [rad] @param duration of the way to it [s]
  void setTarget(const std::array<double, 7>& q, double duration,
                 TargetMotion motion = TargetMotion::kSmooth) noexcept;
  void setStiffness(const std::array<double, 7>& K) noexcept { stiffness_ = K; }  ///< [Nm/rad]
  /// The torque of one tick, without gravity [Nm]. @param dynamics of the state, frame EE
  std::array<double, 7> torque(const franka_core::RobotState& state,
                               const ControlUnitParameters& unit,
                               const franka_core::ArmDynamics& dynamics) noexcept;

 private:
  std::array<double, 7> stiffness_;
  std::array<double, 7> from_, to_;
  std::array<double, 7> desired_;
  double time_{0.0}, duration_{0.0};
  TargetMotion motion_{TargetMotion::kSmooth};
};

/// A spring and damper at the stiffness frame (cartesianImpedance), whose target moves.
class CartesianLaw {
 public:
  /// Begins at the state's desired pose.
  explicit CartesianLaw(const franka_core::RobotState& state) noexcept;

  /// @param O_T_EE 4x4 column-major @param duration of the way to it [s]
  void setTarget(const std::array<double, 16>& O_T_EE, double duration,
                 TargetMotion motion = TargetMotion::kSmooth) noexcept;
  void setStiffness(const std::array<double, 6>& K) noexcept { stiffness_ = K; }  ///< [N/m, Nm/rad]
  void setNullspaceStiffness(double K) noexcept { nullspace_stiffness_ = K; }     ///< [Nm/rad]
  /// The torque of one tick, without gravity [Nm]. @param dynamics of the state, frame EE
  std::array<double, 7> torque(const franka_core::RobotState& state,
                               const ControlUnitParameters& unit,
                               const franka_core::ArmDynamics& dynamics) noexcept;

 private:
  void advance() noexcept;

  std::array<double, 6> stiffness_;
  double nullspace_stiffness_;
  std::array<double, 16> from_, to_, desired_;
  std::array<double, 7> q_;  ///< of the null space [rad]
  double time_{0.0}, duration_{0.0};
  TargetMotion motion_{TargetMotion::kSmooth};
};

}  // namespace franka_sim
