// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "state_publisher.h"

#include <ros/time.h>

#include <algorithm>
#include <cmath>

namespace franka_control {

namespace {

/// roscpp's own thread may also be late by this time. A larger value would make the states older
/// that a slow subscriber receives.
constexpr double kMaxDelay = 0.064;  // [s]

/// While a simulation runs faster than a subscriber reads.
constexpr int kSimulatedQueue = 1000;

int queueSize(double period) {
  if (ros::Time::isSimTime()) {
    return kSimulatedQueue;
  }
  return static_cast<int>(std::clamp(std::ceil(kMaxDelay / period), 1.0,
                                     static_cast<double>(StatePublisher::kWaiting)));
}

}  // namespace

StatePublisher::StatePublisher(const ros::NodeHandle& node, const std::string& topic, double period)
    : ring_(kWaiting) {
  ros::NodeHandle handle(node);
  publisher_ = handle.advertise<franka_msgs::FrankaState>(topic, queueSize(period));
  realtime_tools::detail::PublishingThread::instance().add(this);
}

StatePublisher::~StatePublisher() {
  realtime_tools::detail::PublishingThread::instance().remove(this);
}

franka_msgs::FrankaState* StatePublisher::next() noexcept {
  const std::size_t count = handed_over_.load(std::memory_order_relaxed);
  const bool full = count - sent_.load(std::memory_order_acquire) == kWaiting;
  return full ? nullptr : &ring_[count % kWaiting];
}

void StatePublisher::handOver() noexcept {
  handed_over_.store(handed_over_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  realtime_tools::detail::PublishingThread::instance().noteHandOver();
}

bool StatePublisher::sendHandedOver(Clock::time_point& handed_over) {
  const std::size_t count = handed_over_.load(std::memory_order_acquire);
  std::size_t sent = sent_.load(std::memory_order_relaxed);
  if (sent == count) {
    return false;
  }
  while (sent != count) {
    publisher_.publish(ring_[sent % kWaiting]);
    sent_.store(++sent, std::memory_order_release);
  }
  handed_over = Clock::now();
  return true;
}

}  // namespace franka_control
