// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

#include "status.h"

namespace franka_control {

/// The status of the controllers on /diagnostics: the duration of their cycles.
///
/// The thread of the loop calls `cycleBegins` and `cycleEnds`. Real-time safe.
class LoopHealth {
 public:
  /// @param hardware_id names the robot, or the robots, in the diagnostics
  LoopHealth(const ros::NodeHandle& nh, const std::string& hardware_id);

  void cycleBegins() noexcept { begin_ = std::chrono::steady_clock::now(); }
  void cycleEnds() noexcept;

 private:
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::chrono::steady_clock::time_point begin_{};
  std::atomic<std::uint64_t> cycles_{0};    // of controllers, since the last report
  std::atomic<std::int64_t> total_{0};      // [ns] their total duration
  std::atomic<std::int64_t> longest_{0};    // [ns]
  std::atomic<std::uint64_t> overruns_{0};  // cycles longer than a millisecond, since the start
  Status status_;
};

}  // namespace franka_control
