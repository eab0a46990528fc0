// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>
#include <franka_core/motion_steps.h>

#include <array>

#include "robot/limits/error_set.h"

namespace franka_sim {

using franka_core::JointSample;

/// The commanded motion of the joints, with the check of its next step (decision 14).
///
/// A step is checked against the motion's history and, where states travel as 32 bit floats, also
/// against that history as the client received it: only a step that fails both is refused. A
/// refused step leaves the motion unchanged. Called by one thread. Real-time safe.
class JointMotion {
 public:
  /// At rest at q [rad]; the next step is the first.
  void start(const std::array<double, 7>& q) noexcept;

  /// Takes the next commanded positions [rad]. The first must be where the motion starts, and sets
  /// the history to rest there.
  ErrorSet takePositions(const std::array<double, 7>& q_c,
                         const franka_core::MotionLimits& limits) noexcept;
  /// Takes the next commanded velocities [rad/s], from rest on; positions follow by integration.
  ErrorSet takeVelocities(const std::array<double, 7>& dq_c,
                          const franka_core::MotionLimits& limits) noexcept;
  /// Takes the next positions [rad] from inverse kinematics; checked with the flags 27 to 30.
  /// @param first sets the history to rest there.
  ErrorSet takeSolved(const std::array<double, 7>& q, bool first,
                      const franka_core::MotionLimits& limits) noexcept;
  /// For a Cartesian command that is already refused: checks only the joint jerk of its joint
  /// positions [rad], as real robots do (decision 47). Nothing changes.
  ErrorSet checkJump(const std::array<double, 7>& q,
                     const franka_core::MotionLimits& limits) const noexcept;
  /// A step without a command: the acceleration is held. Before the first step nothing changes.
  ErrorSet extrapolate(const franka_core::MotionLimits& limits) noexcept;
  /// Whether the joints could stand still in the next tick, as after a finished motion.
  ErrorSet checkStop(const franka_core::MotionLimits& limits) const noexcept;
  /// Takes over a motion that needs no check.
  void follow(const JointSample& sample) noexcept { last_ = sample; }

  const JointSample& last() const noexcept { return last_; }

 private:
  JointSample last_;
  bool started_{false};
};

}  // namespace franka_sim
