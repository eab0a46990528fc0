// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/shared_ptr.hpp>
#include <string>
#include <utility>

namespace joint_trajectory_controller {
namespace internal {

/// A goal whose end is decided in the control loop or in a callback, and reported to the client by
/// the callback. The first decision counts; later ones are ignored.
///
/// realtime_tools::RealtimeServerGoalHandle alone allows only one deciding thread, and sends no
/// text to the client.
///
/// Real-time safe. Exceptions: the constructor and runNonRealtime().
/// @tparam Handle a realtime_tools::RealtimeServerGoalHandle
template <class Handle>
class RealtimeGoal {
 public:
  enum class Outcome { kOpen, kClaimed, kAborted, kCanceled, kSucceeded, kReported };

  /// @param handle of an accepted goal, or one that is about to be accepted
  explicit RealtimeGoal(boost::shared_ptr<Handle> handle) : handle_(std::move(handle)) {}

  const boost::shared_ptr<Handle>& handle() const noexcept { return handle_; }

  /// Whether the goal has not been decided yet.
  bool isOpen() const noexcept {
    return outcome_.load(std::memory_order_acquire) == Outcome::kOpen;
  }

  /// Whether it is decided and its result can be read.
  bool isSettled() const noexcept {
    const Outcome outcome = outcome_.load(std::memory_order_acquire);
    return outcome != Outcome::kOpen && outcome != Outcome::kClaimed;
  }

  /// Reserves the decision. After true the caller fills the handle's preallocated_result_ and calls
  /// settle().
  bool claim() noexcept {
    Outcome expected = Outcome::kOpen;
    return outcome_.compare_exchange_strong(expected, Outcome::kClaimed, std::memory_order_acq_rel);
  }

  /// Ends the goal as kAborted, kCanceled or kSucceeded, after claim(). Also informs the handle,
  /// for derived controllers with their own reporting timer.
  void settle(Outcome outcome) noexcept {
    if (outcome == Outcome::kAborted) {
      handle_->setAborted(handle_->preallocated_result_);
    } else if (outcome == Outcome::kCanceled) {
      handle_->setCanceled(handle_->preallocated_result_);
    } else {
      handle_->setSucceeded(handle_->preallocated_result_);
    }
    outcome_.store(outcome, std::memory_order_release);
  }

  /// Reports a decision to the client, once. @param text for the status message
  void runNonRealtime(const std::string& text) {
    Outcome outcome = outcome_.load(std::memory_order_acquire);
    if (outcome != Outcome::kAborted && outcome != Outcome::kCanceled &&
        outcome != Outcome::kSucceeded) {
      return;
    }
    const Outcome decided = outcome;
    if (!outcome_.compare_exchange_strong(outcome, Outcome::kReported, std::memory_order_acq_rel)) {
      return;
    }
    if (decided == Outcome::kAborted) {
      handle_->gh_.setAborted(*handle_->preallocated_result_, text);
    } else if (decided == Outcome::kCanceled) {
      handle_->gh_.setCanceled(*handle_->preallocated_result_, text);
    } else {
      handle_->gh_.setSucceeded(*handle_->preallocated_result_, text);
    }
  }

 private:
  const boost::shared_ptr<Handle> handle_;
  std::atomic<Outcome> outcome_{Outcome::kOpen};
};

}  // namespace internal
}  // namespace joint_trajectory_controller
