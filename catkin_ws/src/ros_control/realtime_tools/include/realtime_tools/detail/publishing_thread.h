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

/// The one thread of a process that sends what its real-time publishers have handed over.
///
/// It looks every half millisecond while there is something to send, and every five milliseconds
/// after a second without: nobody has to wake it, so the real-time side makes no system call, and
/// ten publishers cost one wake-up a cycle instead of ten. The thread exists while there are
/// senders.
class PublishingThread {
 public:
  /// What it looks after.
  class Sender {
   public:
    /// Sends what was handed over. @returns whether there was something. Called by the thread only.
    virtual bool sendHandedOver() = 0;

   protected:
    ~Sender() = default;
  };

  /// The process's own. Lives until the process ends.
  static PublishingThread& instance();

  /// Looks after a sender from now on. Any thread.
  void add(Sender* sender);
  /// Does not touch the sender any more once this has returned. Waits for the look under way. Any
  /// thread but this one; removing what was not added does nothing.
  void remove(Sender* sender);

 private:
  PublishingThread() = default;
  void run();

  std::mutex lifetime_mutex_;  ///< one at a time adds and removes; taken before the other
  std::mutex mutex_;           ///< for what follows
  std::condition_variable changed_;
  std::vector<Sender*> senders_;
  std::thread thread_;
};

}  // namespace detail
}  // namespace realtime_tools
