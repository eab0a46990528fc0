// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>

namespace franka_hw {

/// That a thread wants a robot for a moment, to configure it or to let it recover.
///
/// A loop that only reads states holds FrankaHW::robotMutex() nearly all the time, and a mutex is
/// not fair: who waits for it may wait for ever. While an object of this class lives, such loops
/// stay away from their robots, so that nobody has to wait for them by spinning.
class RobotAccessRequest {
 public:
  RobotAccessRequest() noexcept { waiting_.fetch_add(1, std::memory_order_relaxed); }
  ~RobotAccessRequest() { waiting_.fetch_sub(1, std::memory_order_relaxed); }
  RobotAccessRequest(const RobotAccessRequest&) = delete;
  RobotAccessRequest& operator=(const RobotAccessRequest&) = delete;

  /// Waits for a robot's mutex. Not for loops that read.
  static std::unique_lock<std::mutex> take(std::mutex& robot_mutex) {
    const RobotAccessRequest request;
    return std::unique_lock<std::mutex>(robot_mutex);
  }

  /// The same as long as there is a reason to wait: a motion that has begun meanwhile holds the
  /// mutex until it ends. @returns without the mutex when there is none any more
  template <typename Reason>
  static std::unique_lock<std::mutex> takeWhile(std::mutex& robot_mutex, Reason&& reason) {
    const RobotAccessRequest request;
    std::unique_lock<std::mutex> lock(robot_mutex, std::defer_lock);
    while (reason() && !lock.try_lock()) {
      std::this_thread::sleep_for(kMoment);
    }
    return lock;
  }

  /// For a loop between two reads, without the mutex: sleeps for a moment, and longer while
  /// somebody wants a robot of this process. 5 ms at most: states go on meanwhile.
  static void giveWay() {
    for (int i = 0; i < kMost; i++) {
      std::this_thread::sleep_for(kMoment);
      if (waiting_.load(std::memory_order_relaxed) == 0) {
        return;
      }
    }
  }

  /// Between two looks at whether the robot is free.
  static constexpr std::chrono::microseconds kMoment{100};

 private:
  static constexpr int kMost = 50;
  static inline std::atomic<int> waiting_{0};
};

/// That a motion holds a robot's mutex: it will not let go of it soon, and nobody need wait for it.
class RobotInMotion {
 public:
  /// For whoever holds the mutex, until this object ends.
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
