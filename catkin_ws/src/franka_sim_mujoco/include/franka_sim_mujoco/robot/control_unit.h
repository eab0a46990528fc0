// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <memory>

#include <franka_core/arm_model.h>
#include <franka_core/robot_state.h>
#include <franka_sim_mujoco/robot/plant.h>

namespace franka_sim_mujoco {

/// Thresholds of contact (lower) and collision (upper), [Nm] and [N, N, N, Nm, Nm, Nm].
struct CollisionThresholds {
  std::array<double, 7> lower_torque, upper_torque;
  std::array<double, 6> lower_force, upper_force;
};

/// The configuration a control unit starts with. Defaults and sources: decisions.md, franka_ros.md 9.2.
struct ControlUnitParameters {
  franka_core::ArmModel model;
  std::array<double, 7> max_torque{{87, 87, 87, 87, 12, 12, 12}};  ///< saturation [Nm]
  std::array<double, 7> rotor_inertia{{0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};  ///< B [kg m^2] (decision 1)
  /// Coulomb friction the unit compensates where |dq| > 0.01 rad/s [Nm] (decision 1: zero by default).
  std::array<double, 7> coulomb_friction{};
  std::array<double, 7> viscous_friction{};                   ///< [Nm s/rad]
  int substeps{2};                                            ///< of the physics per tick (decision 3)
  std::array<double, 3> gravity{{0, 0, -9.81}};               ///< O_ddP_O, in O [m/s^2]
  std::array<double, 16> F_T_NE{franka_core::kIdentityTransform};
  std::array<double, 16> NE_T_EE{franka_core::kIdentityTransform};
  std::array<double, 16> EE_T_K{franka_core::kIdentityTransform};
  franka_core::Payload end_effector;                          ///< m_ee, F_x_Cee, I_ee
  franka_core::Payload load;                                  ///< m_load, F_x_Cload, I_load
  CollisionThresholds nominal{{{20, 20, 18, 18, 16, 14, 12}},
                              {{20, 20, 18, 18, 16, 14, 12}},
                              {{20, 20, 20, 25, 25, 25}},
                              {{20, 20, 20, 25, 25, 25}}};
  CollisionThresholds acceleration{nominal};
  std::array<double, 7> joint_stiffness{{3000, 3000, 3000, 2500, 2500, 2000, 2000}};  ///< [Nm/rad]
};

/// The answer to a request; the numbers are the unit's own, each face maps them to its protocol.
enum class RequestStatus {
  kSuccess,
  kNotPossible,      ///< not in the present mode
  kInvalidArgument,  ///< outside its range, not finite, or not a transform
};

/// What Franka's control cabinet does, once a millisecond.
///
/// A tick has two halves: `observe` turns a measurement into state k; `actuate` takes the command that
/// answers state k (or none) and gives the torques that act until k+1. Requests (start of a motion,
/// setters, stops) are made between ticks.
///
/// One thread owns a unit; nothing in it locks, allocates, logs, throws or asks a clock, so the same
/// inputs give the same states bit for bit. Frames and units: franka_core::RobotState.
class ControlUnit {
 public:
  explicit ControlUnit(const ControlUnitParameters& parameters);

  /// First half of a tick. The reference stays valid until the next call.
  const franka_core::RobotState& observe(const ArmMeasurement& measurement) noexcept;

  /// Second half: the motor torques for the coming tick [Nm]: command, gravity of the configured load and
  /// friction compensation, saturated. @param command nullptr when none arrived; the last torque is held.
  const std::array<double, 7>& actuate(const franka_core::RobotCommand* command) noexcept;

  /// Whether the joints are locked (UserStopped, Other).
  bool brakesClosed() const noexcept;

  const franka_core::RobotState& state() const noexcept { return state_; }

  /// Idle -> Move with external torque control (no motion generator).
  RequestStatus startTorqueControl() noexcept;
  /// Move -> Idle; holds where the arm stands.
  RequestStatus stopMotion() noexcept;
  /// The external activation device: pressed stops any motion and closes the brakes, released gives Idle.
  void setUserStop(bool pressed) noexcept;
  /// Clears errors and latched collisions; refused while the user stop is pressed.
  RequestStatus automaticErrorRecovery() noexcept;

  /// NE_T_EE, EE_T_K: refused when not homogeneous (bottom row, unit columns and rows within 1e-5).
  RequestStatus setEE(const std::array<double, 16>& NE_T_EE) noexcept;
  RequestStatus setK(const std::array<double, 16>& EE_T_K) noexcept;
  RequestStatus setLoad(const franka_core::Payload& load) noexcept;
  RequestStatus setCollisionBehavior(const CollisionThresholds& acceleration,
                                     const CollisionThresholds& nominal) noexcept;

  /// After the arm was put elsewhere (reset, teleport): forgets velocities and filters, holds the new pose.
  void restart() noexcept;

  const ControlUnitParameters& parameters() const noexcept { return parameters_; }

 private:
  ControlUnitParameters parameters_;
  franka_core::RobotState state_;
};

}  // namespace franka_sim_mujoco
