// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_limits_interface/detail/limit_handle.h>
#include <ros/duration.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace joint_limits_interface {
namespace internal {

/// The command of the previous cycle; without one, the measured position is used.
class PositionHistory {
 public:
  void clear() { previous_ = std::numeric_limits<double>::quiet_NaN(); }

  double from(const hardware_interface::JointHandle& joint) {
    if (std::isnan(previous_)) {
      previous_ = joint.getPosition();
    }
    return previous_;
  }

  void remember(double command) {
    if (!std::isnan(command)) {
      previous_ = command;
    }
  }

 private:
  double previous_{std::numeric_limits<double>::quiet_NaN()};
};

}  // namespace internal

/// Saturates position commands at the position limits and, with velocity limits, at the distance
/// that a joint can move in one period from the previous command.
class PositionJointSaturationHandle : public internal::LimitHandle {
 public:
  PositionJointSaturationHandle(const hardware_interface::JointHandle& jh,
                                const JointLimits& limits)
      : LimitHandle(jh, limits) {
    if (limits.has_position_limits) {
      range_ = {limits.min_position, limits.max_position};
    }
  }

  /// @param period since the previous command [s]
  void enforceLimits(const ros::Duration& period) {
    const double previous = history_.from(jh_);
    internal::Bounds bounds = range_;
    if (limits_.has_velocity_limits) {
      const double step = limits_.max_velocity * period.toSec();
      bounds = {std::max(previous - step, range_.lower), std::min(previous + step, range_.upper)};
    }
    const double command = bounds.saturate(jh_.getCommand());
    jh_.setCommand(command);
    history_.remember(command);
  }

  /// Resets the previous command. Call it when commands come from another controller.
  void reset() { history_.clear(); }

 private:
  internal::Bounds range_{internal::Bounds::symmetric(internal::kUnlimited)};
  internal::PositionHistory history_;
};

/// Slows position commands down towards the soft position limits, and saturates them at velocity
/// and hard position limits. Distances refer to the previous command, not to the measured position.
class PositionJointSoftLimitsHandle : public internal::LimitHandle {
 public:
  PositionJointSoftLimitsHandle() = default;

  /// @throws JointLimitsInterfaceException when there are no velocity limits.
  PositionJointSoftLimitsHandle(const hardware_interface::JointHandle& jh,
                                const JointLimits& limits, const SoftJointLimits& soft_limits)
      : LimitHandle(jh, limits), soft_limits_(soft_limits) {
    require(limits.has_velocity_limits, "velocity");
  }

  /// @param period since the previous command [s], above zero
  void enforceLimits(const ros::Duration& period) {
    assert(period.toSec() > 0.0);
    const double dt = period.toSec();
    const double previous = history_.from(jh_);
    internal::Bounds velocity = internal::Bounds::symmetric(limits_.max_velocity);
    if (limits_.has_position_limits) {
      velocity = internal::softVelocityBounds(soft_limits_, previous, limits_.max_velocity);
    }
    internal::Bounds bounds{previous + velocity.lower * dt, previous + velocity.upper * dt};
    if (limits_.has_position_limits) {
      bounds = {std::max(bounds.lower, limits_.min_position),
                std::min(bounds.upper, limits_.max_position)};
    }
    const double command = bounds.saturate(jh_.getCommand());
    jh_.setCommand(command);
    history_.remember(command);
  }

  /// Resets the previous command. Call it when commands come from another controller.
  void reset() { history_.clear(); }

 private:
  SoftJointLimits soft_limits_;
  internal::PositionHistory history_;
};

}  // namespace joint_limits_interface
