// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/action_server.h>

#include <atomic>
#include <boost/shared_ptr.hpp>
#include <string>

namespace joint_trajectory_controller {

/// A goal of an action whose end may be decided in the control loop and is told to the client by
/// another thread. Whoever decides first wins, whatever thread it is; later decisions are ignored.
///
/// Real-time safe: isOpen(), isSettled(), claim(), settle(), and writing to `preallocated_result_`
/// between them. Not real-time safe: runNonRealtime().
/// @tparam Action an action, such as control_msgs::FollowJointTrajectoryAction
template <class Action>
class RealtimeGoal {
 public:
  typedef actionlib::ServerGoalHandle<Action> GoalHandle;
  ACTION_DEFINITION(Action)
  enum class Outcome { kOpen, kClaimed, kAborted, kCanceled, kSucceeded, kTold };

  explicit RealtimeGoal(const GoalHandle& gh) : gh_(gh), preallocated_result_(new Result) {}

  /// Whether nobody has decided about the goal yet.
  bool isOpen() const noexcept {
    return outcome_.load(std::memory_order_acquire) == Outcome::kOpen;
  }

  /// Whether it is decided and all about it can be read.
  bool isSettled() const noexcept {
    const Outcome outcome = outcome_.load(std::memory_order_acquire);
    return outcome != Outcome::kOpen && outcome != Outcome::kClaimed;
  }

  /// Reserves the decision. After true the caller fills preallocated_result_ and calls settle().
  bool claim() noexcept {
    Outcome expected = Outcome::kOpen;
    return outcome_.compare_exchange_strong(expected, Outcome::kClaimed, std::memory_order_acq_rel);
  }

  /// Ends the goal as kAborted, kCanceled or kSucceeded, after claim().
  void settle(Outcome outcome) noexcept { outcome_.store(outcome, std::memory_order_release); }

  /// Tells the client about a decision, once. @param text for the status message
  void runNonRealtime(const std::string& text) {
    Outcome outcome = outcome_.load(std::memory_order_acquire);
    if (outcome != Outcome::kAborted && outcome != Outcome::kCanceled &&
        outcome != Outcome::kSucceeded) {
      return;
    }
    const Outcome decided = outcome;
    if (!outcome_.compare_exchange_strong(outcome, Outcome::kTold, std::memory_order_acq_rel)) {
      return;
    }
    if (decided == Outcome::kAborted) {
      gh_.setAborted(*preallocated_result_, text);
    } else if (decided == Outcome::kCanceled) {
      gh_.setCanceled(*preallocated_result_, text);
    } else {
      gh_.setSucceeded(*preallocated_result_, text);
    }
  }

  GoalHandle gh_;
  ResultPtr preallocated_result_;

 private:
  std::atomic<Outcome> outcome_{Outcome::kOpen};
};

}  // namespace joint_trajectory_controller
