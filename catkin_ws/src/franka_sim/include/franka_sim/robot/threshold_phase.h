// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// Which collision thresholds are in effect: those of acceleration while a motion generator
/// accelerates and 100 ms after; else the nominal ones (decision 15). Called by one thread.
/// Real-time safe.
class ThresholdPhase {
 public:
  /// One tick. @param accelerating more than a tenth of an acceleration limit is commanded
  /// @returns whether the thresholds of acceleration are in effect.
  bool update(bool accelerating) noexcept {
    remaining_ = accelerating ? kTicks : (remaining_ > 0 ? remaining_ - 1 : 0);
    return accelerating || remaining_ > 0;
  }
  void restart() noexcept { remaining_ = 0; }

 private:
  static constexpr int kTicks = 100;
  int remaining_{0};
};

}  // namespace franka_sim
