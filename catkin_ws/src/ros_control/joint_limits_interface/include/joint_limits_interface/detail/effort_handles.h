// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_limits_interface/detail/limit_handle.h>
#include <ros/duration.h>

namespace joint_limits_interface {

/// Saturates effort commands at the effort limits, and allows none that pushes further beyond
/// position or velocity limits.
class EffortJointSaturationHandle : public internal::LimitHandle {
 public:
  /// @throws JointLimitsInterfaceException when there are no velocity or no effort limits.
  EffortJointSaturationHandle(const hardware_interface::JointHandle& jh, const JointLimits& limits)
      : LimitHandle(jh, limits) {
    require(limits.has_velocity_limits, "velocity");
    require(limits.has_effort_limits, "efforts");
  }

  void enforceLimits(const ros::Duration& /*period*/) {
    internal::Bounds bounds = internal::Bounds::symmetric(limits_.max_effort);
    if (limits_.has_position_limits) {
      stopOutside(jh_.getPosition(), {limits_.min_position, limits_.max_position}, bounds);
    }
    stopOutside(jh_.getVelocity(), internal::Bounds::symmetric(limits_.max_velocity), bounds);
    jh_.setCommand(bounds.saturate(jh_.getCommand()));
  }

 private:
  static void stopOutside(double value, const internal::Bounds& range, internal::Bounds& effort) {
    if (value < range.lower) {
      effort.lower = 0.0;
    } else if (value > range.upper) {
      effort.upper = 0.0;
    }
  }
};

/// Saturates effort commands at the effort limits, and reduces them where the measured velocity
/// approaches the one allowed at the measured position.
class EffortJointSoftLimitsHandle : public internal::LimitHandle {
 public:
  EffortJointSoftLimitsHandle() = default;

  /// @throws JointLimitsInterfaceException when there are no velocity or no effort limits.
  EffortJointSoftLimitsHandle(const hardware_interface::JointHandle& jh, const JointLimits& limits,
                              const SoftJointLimits& soft_limits)
      : LimitHandle(jh, limits), soft_limits_(soft_limits) {
    require(limits.has_velocity_limits, "velocity");
    require(limits.has_effort_limits, "effort");
  }

  void enforceLimits(const ros::Duration& /*period*/) {
    internal::Bounds velocity = internal::Bounds::symmetric(limits_.max_velocity);
    if (limits_.has_position_limits) {
      velocity =
          internal::softVelocityBounds(soft_limits_, jh_.getPosition(), limits_.max_velocity);
    }
    const internal::Bounds hard = internal::Bounds::symmetric(limits_.max_effort);
    const double measured = jh_.getVelocity();
    const internal::Bounds bounds{
        hard.saturate(-soft_limits_.k_velocity * (measured - velocity.lower)),
        hard.saturate(-soft_limits_.k_velocity * (measured - velocity.upper))};
    jh_.setCommand(bounds.saturate(jh_.getCommand()));
  }

 private:
  SoftJointLimits soft_limits_;
};

}  // namespace joint_limits_interface
