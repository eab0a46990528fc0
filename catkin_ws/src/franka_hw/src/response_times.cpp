// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/response_times.h>

#include <algorithm>

namespace franka_hw {

namespace {

double seconds(ResponseTimes::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void ResponseTimes::motionBegins() noexcept {
  begins_ = true;
  response_ = Clock::duration(-1);
}

void ResponseTimes::stateArrived(franka::Duration robot_time, Clock::time_point now) noexcept {
  if (!begins_ && robot_time == last_time_) {
    return;
  }
  const bool restarts = restarts_.load(std::memory_order_acquire);
  if (restarts) {
    window_ = Window();
    begins_ = true;  // clocks drift: only delays of one report are compared
  }
  if (response_.count() >= 0) {
    window_.cycles++;
    window_.total += response_;
    window_.longest = std::max(window_.longest, response_);
    response_ = Clock::duration(-1);
  }
  noteDelay(robot_time, now);
  begins_ = false;
  last_time_ = robot_time;
  last_arrival_ = now;
  published_.write(window_);
  if (restarts) {  // not for a request that came after the check above
    restarts_.store(false, std::memory_order_release);
  }
}

void ResponseTimes::noteDelay(franka::Duration robot_time, Clock::time_point now) noexcept {
  // Relative to an origin that is the same for all states of a motion.
  const Clock::duration delay =
      now.time_since_epoch() - std::chrono::milliseconds(robot_time.toMSec());
  least_delay_ = begins_ ? delay : std::min(least_delay_, delay);
  largest_delay_ = begins_ ? delay : std::max(largest_delay_, delay);
  window_.spread = std::max(window_.spread, largest_delay_ - least_delay_);
}

void ResponseTimes::commandReady(Clock::time_point since, Clock::time_point now) noexcept {
  response_ = std::max(Clock::duration(0), now - since);
}

ResponseTimes::Report ResponseTimes::take() noexcept {
  Report report;
  if (restarts_.load(std::memory_order_acquire)) {
    return report;
  }
  const Window& window = published_.read();
  report.cycles = window.cycles;
  report.mean = window.cycles > 0 ? seconds(window.total) / window.cycles : 0.0;
  report.longest = seconds(window.longest);
  report.spread = seconds(window.spread);
  restarts_.store(true, std::memory_order_release);
  return report;
}

}  // namespace franka_hw
