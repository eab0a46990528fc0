// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/realtime_clock.h"

#include <chrono>

namespace realtime_tools {

namespace {

/// Both as in the original: the thread's sampling rate, and the weight of the newest sample in the
/// difference of the clocks.
constexpr std::chrono::nanoseconds kPeriod(1000000000 / 750);
constexpr double kNewShare = 0.0001;

constexpr std::int64_t kNanosecondsPerSecond = 1000000000;

}  // namespace

RealtimeClock::RealtimeClock() : thread_(&RealtimeClock::loop, this) {}

RealtimeClock::~RealtimeClock() {
  running_ = false;
  thread_.join();
}

ros::Time RealtimeClock::getSystemTime(const ros::Time& realtime_time) {
  const std::int64_t noted = noted_.load(std::memory_order_relaxed);
  const double now = realtime_time.toSec();
  if (noted != used_) {
    used_ = noted;
    const std::int64_t seconds = noted / kNanosecondsPerSecond;
    follow(now, static_cast<double>(seconds) +
                    1e-9 * static_cast<double>(noted % kNanosecondsPerSecond));
  }
  last_realtime_time_ = now;

  // ros::Time's own sum throws if the result is not a valid time.
  const double offset_ns = offset_ * 1e9;
  const std::int64_t sum =
      static_cast<std::int64_t>(realtime_time.toNSec()) + static_cast<std::int64_t>(offset_ns);
  constexpr std::int64_t kMaxTime = std::int64_t{0xffffffff} * kNanosecondsPerSecond;
  if (sum < 0 || sum > kMaxTime) {
    return realtime_time;
  }
  ros::Time result;
  result.fromNSec(static_cast<std::uint64_t>(sum));
  return result;
}

void RealtimeClock::follow(double realtime_time, double system_time) {
  // The sample was taken at an unknown moment since the last call: on average, in the middle. For
  // the first call this is unknown.
  const double since_last = last_realtime_time_ > 0.0 ? realtime_time - last_realtime_time_ : 0.0;
  const double difference = system_time + 0.5 * since_last - realtime_time;
  offset_ = initialized_ ? (1.0 - kNewShare) * offset_ + kNewShare * difference : difference;
  initialized_ = true;
}

void RealtimeClock::sample() {
  const std::lock_guard<std::mutex> lock(sampling_);
  noted_.store(static_cast<std::int64_t>(ros::Time::now().toNSec()), std::memory_order_relaxed);
}

void RealtimeClock::loop() {
  while (running_) {
    sample();
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace realtime_tools
