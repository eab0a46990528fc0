// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "state_publisher.h"

#include <algorithm>
#include <cmath>

namespace franka_control {

namespace {

constexpr double kMaxPause = 0.002;  // [s]
/// roscpp's own thread may also be late by this time. A larger value would make the states older
/// that a slow subscriber receives.
constexpr double kMaxDelay = 0.064;  // [s]

int queueSize(double period) {
  return static_cast<int>(std::clamp(std::ceil(kMaxDelay / period), 1.0,
                                     static_cast<double>(StatePublisher::kWaiting)));
}

}  // namespace

StatePublisher::StatePublisher(const ros::NodeHandle& node, const std::string& topic, double period)
    : pause_(std::min(period / 2, kMaxPause)), ring_(kWaiting) {
  ros::NodeHandle handle(node);
  publisher_ = handle.advertise<franka_msgs::FrankaState>(topic, queueSize(period));
  thread_ = std::thread([this] { run(); });
}

StatePublisher::~StatePublisher() {
  ends_ = true;
  thread_.join();
}

franka_msgs::FrankaState* StatePublisher::next() noexcept {
  const std::size_t count = handed_over_.load(std::memory_order_relaxed);
  const bool full = count - sent_.load(std::memory_order_acquire) == kWaiting;
  return full ? nullptr : &ring_[count % kWaiting];
}

void StatePublisher::handOver() noexcept {
  handed_over_.store(handed_over_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

void StatePublisher::run() {
  while (!ends_) {
    const std::size_t count = sent_.load(std::memory_order_relaxed);
    if (count == handed_over_.load(std::memory_order_acquire)) {
      std::this_thread::sleep_for(pause_);
      continue;
    }
    publisher_.publish(ring_[count % kWaiting]);
    sent_.store(count + 1, std::memory_order_release);
  }
}

}  // namespace franka_control
