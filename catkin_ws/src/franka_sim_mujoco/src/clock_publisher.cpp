// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/clock_publisher.h>
#include <franka_sim_mujoco/pace.h>

#include <algorithm>
#include <cmath>

namespace franka_sim_mujoco {

namespace {

constexpr std::int64_t kStandStillInterval = 100000000;  // [ns]
/// Chosen here: eleven days; sums of slower rates would leave the range of 64 bits.
constexpr double kMaxInterval = 1e15;  // [ns]

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle& node) : publisher_(node, "/clock", 10) {}

void ClockPublisher::setRate(double rate) {
  interval_ns_ = std::llround(std::min(1e9 / rate, kMaxInterval));
}

void ClockPublisher::tick(const ros::Time& time) {
  const std::int64_t now = monotonicNanoseconds();
  // Tolerance of half an interval: a tick that is slightly early must not lose its message. The
  // bookkeeping below keeps the mean at one message per interval.
  if (now + interval_ns_ / 2 < next_ns_ || !publisher_.trylock()) {
    return;
  }
  publisher_.msg_.clock = time;
  publisher_.unlockAndPublish();
  next_ns_ = std::max(next_ns_, now - interval_ns_) + interval_ns_;
  published_ = time;
  published_ns_ = now;
}

void ClockPublisher::standStill(const ros::Time& time) {
  const std::int64_t now = monotonicNanoseconds();
  if (time == published_ && now - published_ns_ < kStandStillInterval) {
    return;
  }
  if (publisher_.trylock()) {
    publisher_.msg_.clock = time;
    publisher_.unlockAndPublish();
    published_ = time;
    published_ns_ = now;
  }
}

}  // namespace franka_sim_mujoco
