// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace realtime_tools {
namespace detail {

/// The only thread of a process that sends messages of its real-time publishers.
///
/// It checks every 0.5 ms while there are messages and less often while there are none, down to
/// every 5 ms after about 45 ms: it needs no wake-up, so the real-time side makes no system call,
/// and ten publishers cost one wake-up per cycle instead of ten. The thread exists while there are
/// senders.
class PublishingThread {
 public:
  /// A publisher served by the thread.
  class Sender {
   public:
    /// Sends the pending message. @returns whether there was one. Called by the thread only.
    virtual bool sendHandedOver() = 0;

   protected:
    ~Sender() = default;
  };

  /// The process's instance. Exists until the process ends.
  static PublishingThread& instance();

  /// Adds a sender. Any thread.
  void add(Sender* sender);
  /// After return the sender is no longer used. Waits for the running check. Any thread but this
  /// one; removing an unknown sender does nothing.
  void remove(Sender* sender);

 private:
  PublishingThread() = default;
  void run();

  std::mutex lifetime_mutex_;  ///< serialises add and remove; taken before the other
  std::mutex mutex_;           ///< guards the members below
  std::condition_variable changed_;
  std::vector<Sender*> senders_;
  std::thread thread_;
};

}  // namespace detail
}  // namespace realtime_tools
