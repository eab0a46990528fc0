// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <joint_limits_interface/joint_limits.h>
#include <urdf/model.h>

namespace joint_limits_interface {

/// Reads the limits of a URDF joint. URDF has neither acceleration nor jerk: the flag of the former
/// is cleared, the latter is unchanged. @returns false, with `limits` unchanged, without a joint or
/// its `<limit>`.
inline bool getJointLimits(urdf::JointConstSharedPtr urdf_joint, JointLimits& limits) {
  if (!urdf_joint || !urdf_joint->limits) {
    return false;
  }
  limits.has_position_limits =
      urdf_joint->type == urdf::Joint::REVOLUTE || urdf_joint->type == urdf::Joint::PRISMATIC;
  if (limits.has_position_limits) {
    limits.min_position = urdf_joint->limits->lower;
    limits.max_position = urdf_joint->limits->upper;
  }
  if (urdf_joint->type == urdf::Joint::CONTINUOUS) {
    limits.angle_wraparound = true;
  }
  limits.has_velocity_limits = true;
  limits.max_velocity = urdf_joint->limits->velocity;
  limits.has_acceleration_limits = false;
  limits.has_effort_limits = true;
  limits.max_effort = urdf_joint->limits->effort;
  return true;
}

/// Reads the soft limits from a URDF joint's `<safety_controller>`. @returns false, with
/// `soft_limits` unchanged, without a joint or that element.
inline bool getSoftJointLimits(urdf::JointConstSharedPtr urdf_joint, SoftJointLimits& soft_limits) {
  if (!urdf_joint || !urdf_joint->safety) {
    return false;
  }
  soft_limits.min_position = urdf_joint->safety->soft_lower_limit;
  soft_limits.max_position = urdf_joint->safety->soft_upper_limit;
  soft_limits.k_position = urdf_joint->safety->k_position;
  soft_limits.k_velocity = urdf_joint->safety->k_velocity;
  return true;
}

}  // namespace joint_limits_interface
