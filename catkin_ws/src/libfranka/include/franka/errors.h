// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <ostream>
#include <string>

/// @file
/// The errors a robot reports.

namespace franka {

/// The set of errors that are active in a state.
///
/// Each error is a named read-only flag. Real-time safe. Exception: the conversion to text.
struct Errors {
  /// No error.
  Errors() noexcept;
  Errors(const Errors& other) noexcept;
  Errors& operator=(Errors other) noexcept;
  /// @param errors flags in the order of the wire (protocol 4.3).
  explicit Errors(const std::array<bool, 41>& errors) noexcept;

  /// True when at least one error is active.
  explicit operator bool() const noexcept;
  /// Names of the active errors as a JSON list in the order of the wire, `[]` when there is none.
  /// Not real-time safe.
  explicit operator std::string() const;

 private:
  std::array<bool, 41> errors_{};

 public:
  /// @name The robot's errors
  /// In the order of the wire; docs/fidelity.md says when a simulated robot has each of them.
  /// @{
  const bool& joint_position_limits_violation;
  const bool& cartesian_position_limits_violation;
  const bool& self_collision_avoidance_violation;
  const bool& joint_velocity_violation;
  const bool& cartesian_velocity_violation;
  const bool& force_control_safety_violation;
  const bool& joint_reflex;
  const bool& cartesian_reflex;
  const bool& max_goal_pose_deviation_violation;
  const bool& max_path_pose_deviation_violation;
  const bool& cartesian_velocity_profile_safety_violation;
  const bool& joint_position_motion_generator_start_pose_invalid;
  const bool& joint_motion_generator_position_limits_violation;
  const bool& joint_motion_generator_velocity_limits_violation;
  const bool& joint_motion_generator_velocity_discontinuity;
  const bool& joint_motion_generator_acceleration_discontinuity;
  const bool& cartesian_position_motion_generator_start_pose_invalid;
  const bool& cartesian_motion_generator_elbow_limit_violation;
  const bool& cartesian_motion_generator_velocity_limits_violation;
  const bool& cartesian_motion_generator_velocity_discontinuity;
  const bool& cartesian_motion_generator_acceleration_discontinuity;
  const bool& cartesian_motion_generator_elbow_sign_inconsistent;
  const bool& cartesian_motion_generator_start_elbow_invalid;
  const bool& force_controller_desired_force_tolerance_violation;
  const bool& start_elbow_sign_inconsistent;
  const bool& communication_constraints_violation;
  const bool& power_limit_violation;
  const bool& cartesian_motion_generator_joint_position_limits_violation;
  const bool& cartesian_motion_generator_joint_velocity_limits_violation;
  const bool& cartesian_motion_generator_joint_velocity_discontinuity;
  const bool& cartesian_motion_generator_joint_acceleration_discontinuity;
  const bool& cartesian_position_motion_generator_invalid_frame;
  const bool& controller_torque_discontinuity;
  const bool& joint_p2p_insufficient_torque_for_planning;
  const bool& tau_j_range_violation;
  const bool& instability_detected;
  const bool& joint_move_in_wrong_direction;
  const bool& cartesian_spline_motion_generator_violation;
  const bool& joint_via_motion_generator_planning_joint_limit_violation;
  const bool& base_acceleration_initialization_timeout;
  const bool& base_acceleration_invalid_reading;
  /// @}
};

/// Writes the names of the active errors as a JSON list.
std::ostream& operator<<(std::ostream& ostream, const Errors& errors);

}  // namespace franka
