// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_limits_interface/detail/limit_handle.h>
#include <ros/duration.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace joint_limits_interface {

/// Saturates velocity commands at the velocity limits and, with acceleration limits, at the change
/// that a joint can make in one period from the previous command.
class VelocityJointSaturationHandle : public internal::LimitHandle {
 public:
  VelocityJointSaturationHandle() = default;

  /// @throws JointLimitsInterfaceException when there are no velocity limits.
  VelocityJointSaturationHandle(const hardware_interface::JointHandle& jh,
                                const JointLimits& limits)
      : LimitHandle(jh, limits) {
    require(limits.has_velocity_limits, "velocity");
  }

  /// @param period since the previous command [s], above zero with acceleration limits
  void enforceLimits(const ros::Duration& period) {
    internal::Bounds bounds = internal::Bounds::symmetric(limits_.max_velocity);
    if (limits_.has_acceleration_limits) {
      assert(period.toSec() > 0.0);
      const double step = limits_.max_acceleration * period.toSec();
      bounds = {std::max(previous_command_ - step, bounds.lower),
                std::min(previous_command_ + step, bounds.upper)};
    }
    const double command = bounds.saturate(jh_.getCommand());
    jh_.setCommand(command);
    if (!std::isnan(command)) {
      previous_command_ = command;
    }
  }

 private:
  double previous_command_{0.0};  // [rad/s]: joints are assumed to start from rest
};

/// Slows velocity commands down towards the soft position limits, and saturates them at velocity
/// and acceleration limits. Positions and velocities are the measured ones.
class VelocityJointSoftLimitsHandle : public internal::LimitHandle {
 public:
  VelocityJointSoftLimitsHandle(const hardware_interface::JointHandle& jh,
                                const JointLimits& limits, const SoftJointLimits& soft_limits)
      : LimitHandle(jh, limits),
        soft_limits_(soft_limits),
        max_velocity_(limits.has_velocity_limits ? limits.max_velocity : internal::kUnlimited) {}

  /// @param period since the previous command [s]
  void enforceLimits(const ros::Duration& period) {
    internal::Bounds bounds = internal::Bounds::symmetric(max_velocity_);
    if (limits_.has_position_limits) {
      bounds = internal::softVelocityBounds(soft_limits_, jh_.getPosition(), max_velocity_);
    }
    if (limits_.has_acceleration_limits) {
      const double measured = jh_.getVelocity();
      const double step = limits_.max_acceleration * period.toSec();
      bounds = {std::max(measured - step, bounds.lower), std::min(measured + step, bounds.upper)};
    }
    jh_.setCommand(bounds.saturate(jh_.getCommand()));
  }

 private:
  SoftJointLimits soft_limits_;
  double max_velocity_;
};

}  // namespace joint_limits_interface
