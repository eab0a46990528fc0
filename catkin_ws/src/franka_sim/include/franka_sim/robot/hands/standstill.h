// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// Whether a commanded motion has come to rest: enough consecutive samples below a threshold.
/// Samples count after the first motion or, if nothing can move, after 0.2 s (decision 29): at the
/// start everything still rests. Called by one thread. Real-time safe.
class Standstill {
 public:
  explicit Standstill(int samples) noexcept : samples_(samples) {}

  /// A new motion begins.
  void restart() noexcept;
  /// Samples count from now on, with or without motion.
  void countFromNow() noexcept { counting_ = true; }
  /// One tick. @param speed, threshold in the same unit @param period [s] @param commanded whether
  /// a motion can already be the response to the command @returns whether it rests.
  bool update(double speed, double threshold, double period, bool commanded = true) noexcept;

 private:
  int samples_;
  int below_{0};
  double elapsed_{0.0};
  bool counting_{false};
};

}  // namespace franka_sim
