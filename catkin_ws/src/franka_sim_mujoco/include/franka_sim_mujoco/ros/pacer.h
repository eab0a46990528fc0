// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace franka_sim_mujoco {

/// Keeps ticks of 1 ms at a chosen pace against the monotonic clock: absolute deadlines, so that no
/// error adds up. One thread owns it; no allocation, no lock.
class Pacer {
 public:
  /// The slowest pace: a tick lasts a tenth of a second, so that requests are still served
  /// promptly.
  static constexpr double kSlowest = 0.01;

  /// Simulated seconds a wall second; 0 means without waiting.
  /// @returns false and changes nothing when not finite, negative, or slower than kSlowest but not
  /// 0
  bool setFactor(double factor) noexcept;
  double factor() const noexcept { return factor_; }

  /// Begins anew from now, after a pause.
  void restart() noexcept;
  /// Sleeps to the end of the tick. After a hold-up of more than 50 ms the lost time is given up,
  /// shorter ones are caught up.
  void waitForNextTick() noexcept;

 private:
  double factor_{1.0};
  std::int64_t deadline_ns_{0};
};

/// The monotonic clock [ns].
std::int64_t monotonicNanoseconds() noexcept;

/// What the calling thread has computed so far [ns]: for benchmarks, which other programs shall not
/// disturb.
std::int64_t threadNanoseconds() noexcept;

}  // namespace franka_sim_mujoco
