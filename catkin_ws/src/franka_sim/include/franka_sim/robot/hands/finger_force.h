// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// Proportional, integral, derivative gains of one finger [N/m, N/(m s), N s/m].
struct FingerGains {
  double p{100.0}, i{0.0}, d{1.0};
};

/// Force law of one finger that follows a desired position: PID on the position with the derivative
/// taken of the speeds, plus the drive's own damping about the desired speed.
/// With the manual's gains (100, 0, 1) alone a finger with its drive's inertia oscillates for half
/// a second, at a seventh of critical damping; a real hand does not. Called by one thread.
/// Real-time safe.
class FingerForce {
 public:
  /// [N s/m], chosen here: at or above critical for moving finger masses up to 0.16 kg at p = 100
  /// N/m, and stable at 1 kHz from 0.01 kg on.
  static constexpr double kDriveDamping = 7.0;

  explicit FingerForce(const FingerGains& gains) noexcept : gains_(gains) {}

  /// @param error q_d - q [m] @param rate_error dq_d - dq [m/s] @param period [s] @returns [N]
  double update(double error, double rate_error, double period) noexcept;
  /// Resets the integral.
  void restart() noexcept { integral_ = 0.0; }

  const FingerGains& gains() const noexcept { return gains_; }

 private:
  FingerGains gains_;
  double integral_{0.0};  // the integral term itself [N]
};

}  // namespace franka_sim
