// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

namespace franka_sim {

/// The world's time over the clock's. Called by one thread.
class PaceMeter {
 public:
  /// The pace as text; empty until it is known. @param time of the world [s]
  std::string text(double time);

 private:
  using Clock = std::chrono::steady_clock;
  bool started_{false};
  Clock::time_point begin_;
  double time_{0};
  std::string text_;
};

}  // namespace franka_sim
