// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>

namespace franka_sim {

/// Brings a desired motion to rest, each joint alone at its full acceleration and with its jerk
/// limit (decision 16): the stop after a reflex, lost packets, StopMove or the user stop. A joint
/// that is about to rest stops at once, whatever its jerk is. Called by one thread. Real-time safe.
class BrakeTrajectory {
 public:
  /// @param q_d, dq_d, ddq_d desired position, velocity and acceleration [rad, rad/s, rad/s^2];
  /// the last two count as 0 where they are not finite
  void start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
             const std::array<double, 7>& ddq_d, const franka_core::ArmLimits& limits) noexcept;
  /// One tick (1 ms). At rest only ddq changes, to 0.
  void step() noexcept;

  bool atRest() const noexcept;
  const std::array<double, 7>& q() const noexcept { return q_; }      ///< [rad]
  const std::array<double, 7>& dq() const noexcept { return dq_; }    ///< [rad/s]
  const std::array<double, 7>& ddq() const noexcept { return ddq_; }  ///< [rad/s^2]

 private:
  std::array<double, 7> q_{}, dq_{}, ddq_{}, ddq_max_{};
  std::array<double, 7> change_{};  ///< of the acceleration in a tick [rad/s^2]
};

}  // namespace franka_sim
