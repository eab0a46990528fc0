// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>

#include <array>
#include <cstddef>

#include "robot/motion/joint_motion.h"

namespace franka_sim {

/// Moves the joints to a target that may change at any time (protocol 10's asynchronous motions).
///
/// Each joint alone runs the time-optimal motion under its limits of velocity and acceleration,
/// exact to the tick. The arm gets its mean over four ticks, which keeps the jerk limit as well
/// (four ticks are 2 ddq_max / dddq_max for both arms) and ends exactly on the target. Where the
/// arm's velocity limit shrinks towards a joint's end, so does the speed. Called by one thread.
/// Real-time safe.
class AsyncJointGenerator {
 public:
  /// Starts at rest at q [rad]. @param maximum_velocity positive [rad/s]; limited to the arm's
  /// limits.
  void start(const std::array<double, 7>& q,
             const std::array<double, 7>& maximum_velocity) noexcept;
  /// Target [rad]; finite, and reachable from position() within the limits (MotionGenerator).
  void setTarget(const std::array<double, 7>& target) noexcept { target_ = target; }
  /// Brakes to rest instead of moving to the target.
  void stop() noexcept { stopping_ = true; }
  /// One tick (1 ms) on.
  void step(const franka_core::MotionLimits& limits) noexcept;

  /// Whether neither the motion nor its mean moves any more.
  bool atRest() const noexcept;
  const JointSample& sample() const noexcept { return sample_; }
  /// Position of the motion [rad], before the mean over the last ticks.
  const std::array<double, 7>& position() const noexcept { return q_; }

 private:
  static constexpr std::size_t kWindow = 4;

  std::array<double, 7> target_{}, maximum_velocity_{};
  std::array<double, 7> q_{}, dq_{};                      // before the mean
  std::array<std::array<double, 7>, kWindow> history_{};  // of q_, a ring
  std::size_t newest_{0};
  JointSample sample_;
  bool stopping_{false};
};

}  // namespace franka_sim
