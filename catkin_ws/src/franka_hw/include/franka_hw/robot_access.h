// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

namespace franka_hw {

/// RAII request for short exclusive access to a robot, to configure it or to let it recover.
///
/// A loop that only reads states holds FrankaHW::robotMutex() nearly all the time, and a mutex is
/// not fair: another thread may wait for it for ever. While an object of this class exists, such
/// loops leave their robots alone. Thread-safe. Not real-time safe.
class RobotAccessRequest {
 public:
  RobotAccessRequest() noexcept { waiting_.fetch_add(1, std::memory_order_relaxed); }
  ~RobotAccessRequest() { waiting_.fetch_sub(1, std::memory_order_relaxed); }
  RobotAccessRequest(const RobotAccessRequest&) = delete;
  RobotAccessRequest& operator=(const RobotAccessRequest&) = delete;

  /// Locks a robot's mutex; waits for it. Loops that read states do not call this.
  static std::unique_lock<std::mutex> take(std::mutex& robot_mutex) {
    const RobotAccessRequest request;
    return std::unique_lock<std::mutex>(robot_mutex);
  }

  /// Locks a robot's mutex, but waits only while `reason` returns true: a motion that began in the
  /// meantime holds the mutex until it ends. @returns an unlocked lock when `reason` returns false
  template <typename Reason>
  static std::unique_lock<std::mutex> takeWhile(std::mutex& robot_mutex, Reason&& reason) {
    const RobotAccessRequest request;
    std::unique_lock<std::mutex> lock(robot_mutex, std::defer_lock);
    while (reason() && !lock.try_lock()) {
      std::this_thread::sleep_for(kMoment);
    }
    return lock;
  }

  /// A loop calls this between two reads, without the mutex: sleeps for 0.1 ms, and longer while
  /// there is a request for a robot of this process, at most 5 ms, so that states go on.
  static void giveWay() {
    for (int i = 0; i < kMost; i++) {
      std::this_thread::sleep_for(kMoment);
      if (waiting_.load(std::memory_order_relaxed) == 0) {
        return;
      }
    }
  }

  /// Period at which a waiting thread tries again.
  static constexpr std::chrono::microseconds kMoment{100};

 private:
  static constexpr int kMost = 50;
  static inline std::atomic<int> waiting_{0};
};

/// Marks a robot's mutex as held by a motion, which keeps it until it ends: waiting is useless.
class RobotInMotion {
 public:
  /// The caller holds the mutex for as long as this object exists.
  explicit RobotInMotion(const std::mutex& robot_mutex) : robot_mutex_(&robot_mutex) {
    const std::lock_guard<std::mutex> lock(mutex_);
    moving_.insert(robot_mutex_);
  }
  ~RobotInMotion() {
    const std::lock_guard<std::mutex> lock(mutex_);
    moving_.erase(robot_mutex_);
  }
  RobotInMotion(const RobotInMotion&) = delete;
  RobotInMotion& operator=(const RobotInMotion&) = delete;

  static bool holds(const std::mutex& robot_mutex) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return moving_.count(&robot_mutex) != 0;
  }

 private:
  const std::mutex* robot_mutex_;
  static inline std::mutex mutex_;
  static inline std::set<const std::mutex*> moving_;  // guarded by mutex_
};

}  // namespace franka_hw
