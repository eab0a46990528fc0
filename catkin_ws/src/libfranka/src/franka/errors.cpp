// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/errors.h>
#include <franka_core/robot_error.h>

#include <algorithm>
#include <sstream>

namespace franka {

static_assert(franka_core::kErrorCount == 41, "franka::Errors names each error of the table");

Errors::Errors() noexcept : Errors(std::array<bool, 41>{}) {}

Errors::Errors(const Errors& other) noexcept : Errors(other.errors_) {}

Errors& Errors::operator=(Errors other) noexcept {
  // The references stay bound to this object's own flags; only the flags are copied.
  errors_ = other.errors_;
  return *this;
}

Errors::Errors(const std::array<bool, 41>& errors) noexcept
    : errors_(errors),
      joint_position_limits_violation(errors_[0]),
      cartesian_position_limits_violation(errors_[1]),
      self_collision_avoidance_violation(errors_[2]),
      joint_velocity_violation(errors_[3]),
      cartesian_velocity_violation(errors_[4]),
      force_control_safety_violation(errors_[5]),
      joint_reflex(errors_[6]),
      cartesian_reflex(errors_[7]),
      max_goal_pose_deviation_violation(errors_[8]),
      max_path_pose_deviation_violation(errors_[9]),
      cartesian_velocity_profile_safety_violation(errors_[10]),
      joint_position_motion_generator_start_pose_invalid(errors_[11]),
      joint_motion_generator_position_limits_violation(errors_[12]),
      joint_motion_generator_velocity_limits_violation(errors_[13]),
      joint_motion_generator_velocity_discontinuity(errors_[14]),
      joint_motion_generator_acceleration_discontinuity(errors_[15]),
      cartesian_position_motion_generator_start_pose_invalid(errors_[16]),
      cartesian_motion_generator_elbow_limit_violation(errors_[17]),
      cartesian_motion_generator_velocity_limits_violation(errors_[18]),
      cartesian_motion_generator_velocity_discontinuity(errors_[19]),
      cartesian_motion_generator_acceleration_discontinuity(errors_[20]),
      cartesian_motion_generator_elbow_sign_inconsistent(errors_[21]),
      cartesian_motion_generator_start_elbow_invalid(errors_[22]),
      force_controller_desired_force_tolerance_violation(errors_[23]),
      start_elbow_sign_inconsistent(errors_[24]),
      communication_constraints_violation(errors_[25]),
      power_limit_violation(errors_[26]),
      cartesian_motion_generator_joint_position_limits_violation(errors_[27]),
      cartesian_motion_generator_joint_velocity_limits_violation(errors_[28]),
      cartesian_motion_generator_joint_velocity_discontinuity(errors_[29]),
      cartesian_motion_generator_joint_acceleration_discontinuity(errors_[30]),
      cartesian_position_motion_generator_invalid_frame(errors_[31]),
      controller_torque_discontinuity(errors_[32]),
      joint_p2p_insufficient_torque_for_planning(errors_[33]),
      tau_j_range_violation(errors_[34]),
      instability_detected(errors_[35]),
      joint_move_in_wrong_direction(errors_[36]),
      cartesian_spline_motion_generator_violation(errors_[37]),
      joint_via_motion_generator_planning_joint_limit_violation(errors_[38]),
      base_acceleration_initialization_timeout(errors_[39]),
      base_acceleration_invalid_reading(errors_[40]) {}

Errors::operator bool() const noexcept {
  return std::any_of(errors_.begin(), errors_.end(), [](bool active) { return active; });
}

Errors::operator std::string() const {
  std::string names;
  for (std::size_t i = 0; i < errors_.size(); i++) {
    if (errors_[i]) {
      names += (names.empty() ? "\"" : ", \"") + std::string(franka_core::kErrorNames[i]) + "\"";
    }
  }
  return "[" + names + "]";
}

std::ostream& operator<<(std::ostream& ostream, const Errors& errors) {
  return ostream << static_cast<std::string>(errors);
}

}  // namespace franka
