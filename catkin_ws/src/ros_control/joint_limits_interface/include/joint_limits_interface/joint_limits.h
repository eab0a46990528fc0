// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace joint_limits_interface {

/// Mechanical limits of a joint. A number is valid only if its flag is set. Units are those of a
/// revolute joint; for a prismatic one [m] replaces [rad] and [N] replaces [Nm].
struct JointLimits {
  double min_position{0.0};      ///< [rad]
  double max_position{0.0};      ///< [rad]
  double max_velocity{0.0};      ///< [rad/s]
  double max_acceleration{0.0};  ///< [rad/s^2]
  double max_jerk{0.0};          ///< [rad/s^3]
  double max_effort{0.0};        ///< [Nm]

  bool has_position_limits{false};      ///< of positions
  bool has_velocity_limits{false};      ///< of the velocity
  bool has_acceleration_limits{false};  ///< of the acceleration
  bool has_jerk_limits{false};          ///< of the jerk
  bool has_effort_limits{false};        ///< of the effort
  bool angle_wraparound{false};         ///< continuous
};

/// Limits that act before the hard ones: velocity springs around the position limits and effort
/// springs around those velocities, as in the safety controller of URDF.
struct SoftJointLimits {
  double min_position{0.0};  ///< [rad]
  double max_position{0.0};  ///< [rad]
  double k_position{0.0};    ///< velocity per distance to the position limit [1/s]
  double k_velocity{0.0};    ///< effort per distance to the velocity limit [Nms/rad]
};

}  // namespace joint_limits_interface
