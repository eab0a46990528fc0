// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/arm_state.h>

#include <atomic>
#include <functional>
#include <mutex>

namespace franka_hw {

/// The mutex of one robot. Every thread that talks to the robot holds it, a motion until it ends.
///
/// A loop that only reads states holds it nearly all the time, and a mutex is not fair: another
/// thread may wait for ever. Such a loop calls giveWay(), the others announce themselves by a
/// Request or take(). Thread-safe. Not real-time safe.
class RobotMutex : public std::mutex {
 public:
  /// @param state of the arm, which says whether a motion has the robot; outlives this
  explicit RobotMutex(const ArmStateMachine& state) noexcept : state_(state) {}

  /// RAII request for the robot: while it exists, the reading loop leaves the robot alone.
  class Request {
   public:
    explicit Request(RobotMutex& mutex) noexcept : waiting_(mutex.waiting_) { ++waiting_; }
    ~Request() { --waiting_; }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;

   private:
    std::atomic<int>& waiting_;
  };

  /// Locks, and waits for that as long as it takes.
  std::unique_lock<std::mutex> take();

  /// Locks, but waits only while `reason` returns true: a motion that began in the meantime has the
  /// robot until it ends. @returns an unlocked lock when `reason` returns false
  std::unique_lock<std::mutex> takeWhile(const std::function<bool()>& reason);

  /// Tries to lock for half a second. @param busy called between two attempts; may throw
  /// @returns an unlocked lock when that time is over
  static std::unique_lock<std::mutex> takeSoon(std::mutex& mutex,
                                               const std::function<void()>& busy);

  /// The reading loop calls this between two reads, unlocked: sleeps for 0.1 ms, and longer while
  /// there is a request, at most 5 ms, so that states go on.
  void giveWay() const;

  /// Whether a motion has the robot, so that waiting for it is useless. Real-time safe.
  bool inMotion() const noexcept { return isInMotion(state_.state()); }

 private:
  const ArmStateMachine& state_;
  std::atomic<int> waiting_{0};
};

}  // namespace franka_hw
