// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "realtime_tools/detail/publishing_schedule.h"

namespace realtime_tools {
namespace detail {

/// The only thread of a process that sends messages of its real-time publishers.
///
/// It checks for messages at the times of PublishingSchedule. It needs no wake-up, so the real-time
/// side makes no system call, and ten publishers cost one wake-up per cycle instead of ten. The
/// thread exists while there are senders.
class PublishingThread {
 public:
  /// A publisher served by the thread.
  class Sender {
   public:
    /// Sends the pending message. Called by the thread only.
    /// @param handed_over set to the time when the message was handed over
    /// @returns false if there was none, or nobody to send it to
    virtual bool sendHandedOver(PublishingSchedule::Clock::time_point& handed_over) = 0;

   protected:
    ~Sender() = default;

   private:
    friend class PublishingThread;
    PublishingSchedule schedule_;
  };

  /// The process's instance. Exists until the process ends.
  static PublishingThread& instance() noexcept;

  /// Adds a sender. Thread-safe.
  void add(Sender* sender);
  /// After return the sender is no longer used. Waits for the running check. Any thread but this
  /// one; removing an unknown sender does nothing.
  void remove(Sender* sender) noexcept;
  /// Sends all pending messages in the calling thread. Any thread but this one.
  /// Not real-time safe.
  void sendPending();

  /// A message was handed over. Real-time safe.
  void noteHandOver() noexcept { pending_.store(true, std::memory_order_release); }
  /// Whether one was since the last sendPending(). Real-time safe.
  bool hasPending() const noexcept { return pending_.load(std::memory_order_acquire); }

 private:
  PublishingThread() = default;
  void run();
  PublishingSchedule::Clock::time_point sendAll();

  std::mutex lifetime_mutex_;  ///< serializes add and remove; taken before the other
  std::mutex mutex_;           ///< guards the members below
  std::condition_variable changed_;
  std::vector<Sender*> senders_;
  std::thread thread_;
  std::atomic<bool> pending_{false};
};

}  // namespace detail
}  // namespace realtime_tools
