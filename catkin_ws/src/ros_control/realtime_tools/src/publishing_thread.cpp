// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/detail/publishing_thread.h"

#include <algorithm>

namespace realtime_tools {
namespace detail {

namespace {

// Twice in a cycle of the fastest loops, so that a message is taken before the next one is due,
// whatever the phase of the checks.
constexpr std::chrono::microseconds kFirstWait{500};
constexpr std::chrono::microseconds kLongestWait{5000};

constexpr int kMaxIdleChecks = 20;  // the longest wait is reached

}  // namespace

PublishingThread& PublishingThread::instance() {
  // Never destroyed: publishers with static storage may outlive all other objects.
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

void PublishingThread::remove(Sender* sender) {
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

void PublishingThread::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  int idle_checks = 0;
  while (!senders_.empty()) {
    bool sent = false;
    for (Sender* const sender : senders_) {
      sent = sender->sendHandedOver() || sent;
    }
    idle_checks = sent ? 0 : std::min(idle_checks + 1, kMaxIdleChecks);
    // The longer the pause, the longer the next message may wait.
    const auto wait = std::min(kFirstWait * (1 + idle_checks / 2), kLongestWait);
    changed_.wait_for(lock, wait);
  }
}

}  // namespace detail
}  // namespace realtime_tools
