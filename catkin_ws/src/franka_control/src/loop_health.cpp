// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "loop_health.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace franka_control {

namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::int64_t kMillisecond = 1000000;  // [ns]

}  // namespace

LoopHealth::LoopHealth(const ros::NodeHandle& nh, const std::string& hardware_id)
    : status_(nh, "Control loop", hardware_id, [this](auto& status) { describe(status); }) {}

void LoopHealth::cycleEnds() noexcept {
  const std::int64_t elapsed = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                   std::chrono::steady_clock::now() - begin_)
                                   .count();
  cycles_.fetch_add(1, std::memory_order_relaxed);
  total_.fetch_add(elapsed, std::memory_order_relaxed);
  if (elapsed > longest_.load(std::memory_order_relaxed)) {
    longest_.store(elapsed, std::memory_order_relaxed);
  }
  if (elapsed > kMillisecond) {
    overruns_.fetch_add(1, std::memory_order_relaxed);
  }
}

void LoopHealth::describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::uint64_t cycles = cycles_.exchange(0, std::memory_order_relaxed);
  const std::int64_t total = total_.exchange(0, std::memory_order_relaxed);
  const std::int64_t longest = longest_.exchange(0, std::memory_order_relaxed);
  if (cycles == 0) {
    status.summary(DiagnosticStatus::WARN, "The controllers were not updated");
  } else if (longest > kMillisecond) {
    status.summary(DiagnosticStatus::WARN, "The controllers took longer than a millisecond");
  } else {
    status.summary(DiagnosticStatus::OK, "The controllers keep time");
  }
  status.add("Cycles since the last report", cycles);
  status.add("Mean time of the controllers [ms]", cycles > 0 ? 1e-6 * total / cycles : 0.0);
  status.add("Longest time of the controllers [ms]", 1e-6 * longest);
  status.add("Cycles longer than a millisecond, since the start", overruns_.load());
}

}  // namespace franka_control
