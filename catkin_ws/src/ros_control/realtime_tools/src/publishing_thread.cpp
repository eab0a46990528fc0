// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/detail/publishing_thread.h"

#include <algorithm>

namespace realtime_tools {
namespace detail {

PublishingThread& PublishingThread::instance() noexcept {
  // Never destroyed: publishers with static storage may outlive all other objects.
  // Without memory the program ends. NOLINTNEXTLINE(bugprone-unhandled-exception-at-new)
  static PublishingThread* const thread = new PublishingThread();
  return *thread;
}

void PublishingThread::add(Sender* sender) {
  const std::lock_guard<std::mutex> lifetime(lifetime_mutex_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    senders_.push_back(sender);
  }
  changed_.notify_one();
  if (!thread_.joinable()) {
    thread_ = std::thread(&PublishingThread::run, this);
  }
}

void PublishingThread::remove(Sender* sender) noexcept {
  const std::lock_guard<std::mutex> lifetime(lifetime_mutex_);
  bool last = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    senders_.erase(std::remove(senders_.begin(), senders_.end(), sender), senders_.end());
    last = senders_.empty();
  }
  if (last && thread_.joinable()) {
    changed_.notify_one();
    thread_.join();
    thread_ = std::thread();
  }
}

void PublishingThread::sendPending() {
  pending_.store(false, std::memory_order_relaxed);
  const std::lock_guard<std::mutex> lock(mutex_);
  sendAll();
}

void PublishingThread::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!senders_.empty()) {
    changed_.wait_until(lock, sendAll());
  }
}

// Returns the time of the next look.
PublishingSchedule::Clock::time_point PublishingThread::sendAll() {
  auto next = PublishingSchedule::Clock::time_point::max();
  for (Sender* const sender : senders_) {
    PublishingSchedule::Clock::time_point handed_over;
    if (sender->sendHandedOver(handed_over)) {
      sender->schedule_.found(handed_over);
    }
    next = std::min(next, sender->schedule_.next(PublishingSchedule::Clock::now()));
  }
  return next;
}

}  // namespace detail
}  // namespace realtime_tools
