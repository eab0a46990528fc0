// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// Brings a desired motion to rest, each joint alone at its full acceleration (decision 16): the
/// stop after a reflex, lost packets, StopMove or the user stop. No jerk limit: a stop must be
/// short. Called by one thread. Real-time safe.
class BrakeTrajectory {
 public:
  /// @param q_d, dq_d desired position and velocity [rad, rad/s]; a velocity that is not finite
  /// counts as 0
  /// @param ddq_max deceleration, positive [rad/s^2]
  void start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
             const std::array<double, 7>& ddq_max) noexcept;
  /// One tick (1 ms). At rest only ddq changes, to 0.
  void step() noexcept;

  bool atRest() const noexcept;
  const std::array<double, 7>& q() const noexcept { return q_; }      ///< [rad]
  const std::array<double, 7>& dq() const noexcept { return dq_; }    ///< [rad/s]
  const std::array<double, 7>& ddq() const noexcept { return ddq_; }  ///< [rad/s^2]

 private:
  std::array<double, 7> q_{}, dq_{}, ddq_{}, ddq_max_{};
};

}  // namespace franka_sim
