// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>
#include <franka_core/motion_steps.h>

#include <array>

#include "robot/limits/error_set.h"
#include "robot/transforms.h"

namespace franka_sim {

using franka_core::CartesianSample;
using franka_core::ElbowSample;

/// A commanded elbow.
struct ElbowCommand {
  bool valid{false};              ///< false: the last commanded elbow stays
  std::array<double, 2> elbow{};  ///< q3 [rad] and the sign of the elbow, +1 or -1
};

/// The commanded motion of end effector and elbow, with the check of its next step; JointMotion
/// describes how. The norms of the linear and of the angular part of velocity, acceleration and
/// jerk and those of the elbow are checked together (decisions 14, 47). Called by one thread.
/// Real-time safe.
class CartesianMotion {
 public:
  /// At rest. @param pose O_T_EE @param elbow q3 [rad] and its sign.
  void start(const Transform& pose, const std::array<double, 2>& elbow) noexcept;

  /// Takes the next commanded pose O_T_EE; it is kept orthonormalized. The first must be where the
  /// motion starts, and sets the history to rest there.
  /// @param sign the elbow's present sign, which a commanded elbow must have.
  ErrorSet takePose(const Transform& pose, const ElbowCommand& elbow, double sign,
                    const franka_core::MotionLimits& limits) noexcept;
  /// Takes the next commanded twist in O [m/s, rad/s], from rest on; the pose follows by
  /// integration.
  ErrorSet takeTwist(const std::array<double, 6>& twist, const ElbowCommand& elbow, double sign,
                     const franka_core::MotionLimits& limits) noexcept;
  /// A step without a command: accelerations are held. Before the first step nothing changes.
  ErrorSet extrapolate(const franka_core::MotionLimits& limits) noexcept;
  /// Whether end effector and elbow could stand still in the next tick.
  ErrorSet checkStop(const franka_core::MotionLimits& limits) const noexcept;

  const CartesianSample& last() const noexcept { return last_; }
  /// The last step if it violated a limit; nullptr if it was taken, or was not a motion at all.
  const CartesianSample* refused() const noexcept { return has_refused_ ? &refused_ : nullptr; }

 private:
  ErrorSet checkElbow(const ElbowCommand& elbow, double sign) const noexcept;
  ErrorSet take(const CartesianSample& step, const ErrorSet& errors) noexcept;

  CartesianSample last_, refused_;
  bool started_{false}, has_refused_{false};
};

}  // namespace franka_sim
