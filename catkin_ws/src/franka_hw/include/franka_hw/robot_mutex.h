// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/arm_state.h>

#include <atomic>
#include <functional>
#include <mutex>

namespace franka_hw {

/// The mutex of one robot. Every thread that communicates with the robot holds it; a motion holds
/// it until its end.
///
/// A loop that only reads states holds it nearly all the time, and because a mutex is not fair,
/// another thread may wait for ever. Such a loop calls yieldToRequests(); the others use a Request
/// or take(). Thread-safe. Not real-time safe.
class RobotMutex : public std::mutex {
 public:
  /// @param state of the arm, which shows whether a motion holds the robot; outlives this object
  explicit RobotMutex(const ArmStateMachine& state) noexcept : state_(state) {}

  /// RAII request for the robot: while it exists, the reading loop leaves the mutex unlocked for
  /// longer.
  class Request {
   public:
    explicit Request(RobotMutex& mutex) noexcept : waiting_(mutex.waiting_) { ++waiting_; }
    ~Request() { --waiting_; }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;

   private:
    std::atomic<int>& waiting_;
  };

  /// Locks, and waits without a time limit.
  std::unique_lock<std::mutex> take();

  /// Locks, but waits only while `reason` returns true, because a motion that has begun meanwhile
  /// holds the robot until its end. @returns an unlocked lock if `reason` returns false
  std::unique_lock<std::mutex> takeWhile(const std::function<bool()>& reason);

  /// Tries to lock for half a second. @param busy called between two attempts; may throw
  /// @returns an unlocked lock after that time
  static std::unique_lock<std::mutex> lockSoon(std::mutex& mutex,
                                               const std::function<void()>& busy);

  /// The reading loop calls this, unlocked, between two reads: sleeps for 0.1 ms, and longer while
  /// there is a request, at most 5 ms, so that reading continues. @returns how often it slept
  int yieldToRequests() const;

  /// Whether a motion holds the robot, so that waiting for it is useless. Real-time safe.
  bool inMotion() const noexcept { return isInMotion(state_.state()); }

 private:
  const ArmStateMachine& state_;
  std::atomic<int> waiting_{0};
};

}  // namespace franka_hw
