// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// Which collision thresholds are in effect: those of acceleration while a motion generator
/// accelerates and 100 ms after; else the nominal ones (decision 15). Called by one thread.
/// Real-time safe.
class ThresholdPhase {
 public:
  /// One tick.
  void step() noexcept {
    remaining_ = accelerating_ ? kTicks : (remaining_ > 0 ? remaining_ - 1 : 0);
    in_acceleration_ = remaining_ > 0;
  }
  /// Whether more than a tenth of an acceleration limit is commanded, from the next tick on.
  void setAccelerating(bool accelerating) noexcept { accelerating_ = accelerating; }
  /// Clears earlier accelerations; the thresholds of this tick stay.
  void restart() noexcept {
    accelerating_ = false;
    remaining_ = 0;
  }
  /// Whether the thresholds of acceleration are in effect in this tick.
  bool inAcceleration() const noexcept { return in_acceleration_; }

 private:
  static constexpr int kTicks = 100;
  bool accelerating_{false}, in_acceleration_{false};
  int remaining_{0};
};

}  // namespace franka_sim
