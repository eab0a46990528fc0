// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace joint_limits_interface {

/// What the mechanics of a joint allow. A number counts only where its flag is set. Units are those
/// of a revolute joint; read [m] for [rad] and [N] for [Nm] with a prismatic one.
struct JointLimits {
  double min_position{0.0};      ///< [rad]
  double max_position{0.0};      ///< [rad]
  double max_velocity{0.0};      ///< [rad/s]
  double max_acceleration{0.0};  ///< [rad/s^2]
  double max_jerk{0.0};          ///< [rad/s^3]
  double max_effort{0.0};        ///< [Nm]

  bool has_position_limits{false};
  bool has_velocity_limits{false};
  bool has_acceleration_limits{false};
  bool has_jerk_limits{false};
  bool has_effort_limits{false};
  bool angle_wraparound{false};  ///< turns without end
};

/// Limits that begin to act before the hard ones: springs of velocity around the position limits
/// and springs of effort around those velocities, as the safety controller of URDF describes them.
struct SoftJointLimits {
  double min_position{0.0};  ///< [rad]
  double max_position{0.0};  ///< [rad]
  double k_position{0.0};    ///< velocity per distance to the position limit [1/s]
  double k_velocity{0.0};    ///< effort per distance to the velocity limit [Nms/rad]
};

}  // namespace joint_limits_interface
