// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/action_definition.h>
#include <actionlib/server/action_server.h>
#include <actionlib_msgs/GoalStatus.h>
#include <boost_bind_compat/global_placeholders.h>
#include <ros/timer.h>

#include <atomic>

namespace realtime_tools {

/// Lets a real-time thread end an action's goal and give feedback: it stores the request, and a
/// timer outside the loop executes it.
///
/// One real-time thread calls setAborted(), setCanceled(), setSucceeded() and setFeedback(); one
/// other thread calls runNonRealtime(). Both may run at the same time.
///
/// Messages passed in must stay alive elsewhere: the preallocated ones do, as long as this object.
/// A preallocated result must be filled before it is passed, and not changed afterwards.
///
/// @tparam Action an action's type, for instance control_msgs::FollowJointTrajectoryAction.
template <class Action>
class RealtimeServerGoalHandle {
 private:
  ACTION_DEFINITION(Action);

 public:
  typedef actionlib::ServerGoalHandle<Action> GoalHandle;

  GoalHandle gh_;                      ///< of actionlib
  ResultPtr preallocated_result_;      ///< sent at the end
  FeedbackPtr preallocated_feedback_;  ///< sent meanwhile

  /// @param gh the goal. @param preallocated_result and @param preallocated_feedback messages to
  /// use; each is allocated here if it is null. Not real-time safe.
  RealtimeServerGoalHandle(GoalHandle& gh, const ResultPtr& preallocated_result = ResultPtr(),
                           const FeedbackPtr& preallocated_feedback = FeedbackPtr())
      : gh_(gh),
        preallocated_result_(preallocated_result ? preallocated_result : ResultPtr(new Result)),
        preallocated_feedback_(preallocated_feedback ? preallocated_feedback
                                                     : FeedbackPtr(new Feedback)) {}

  RealtimeServerGoalHandle(const RealtimeServerGoalHandle&) = delete;
  RealtimeServerGoalHandle& operator=(const RealtimeServerGoalHandle&) = delete;

  /// Requests an end of the goal. The first request of the three counts, later ones are ignored.
  /// Real-time safe. @param result to send; none if null.
  void setAborted(ResultConstPtr result = ResultConstPtr()) { request(End::kAborted, result); }
  /// The same for a goal that was canceled. Real-time safe.
  void setCanceled(ResultConstPtr result = ResultConstPtr()) { request(End::kCanceled, result); }
  /// The same for a goal that was reached. Real-time safe.
  void setSucceeded(ResultConstPtr result = ResultConstPtr()) { request(End::kSucceeded, result); }

  /// Sets the feedback that every runNonRealtime() sends while the goal is active. If the timer is
  /// just reading the previous one, this one is dropped; the preallocated feedback may be filled
  /// and passed in every cycle. Real-time safe.
  void setFeedback(FeedbackConstPtr feedback = FeedbackConstPtr()) {
    if (feedback_busy_.test_and_set(std::memory_order_acquire)) {
      return;
    }
    feedback_.swap(feedback);
    feedback_busy_.clear(std::memory_order_release);
  }

  /// Whether there is a goal. Not real-time safe.
  bool valid() { return gh_.getGoal() != nullptr; }

  /// Executes the requests: ends the goal if its state allows (an abort or a success while it is
  /// active or preempting, a cancellation while preempting), and sends feedback if it was active.
  /// For a ros::Timer. Not real-time safe.
  void runNonRealtime(const ros::TimerEvent& /*event*/) {
    if (!valid()) {
      return;
    }
    const std::uint8_t status = gh_.getGoalStatus().status;
    const bool active = status == actionlib_msgs::GoalStatus::ACTIVE;
    const bool preempting = status == actionlib_msgs::GoalStatus::PREEMPTING;
    endAsRequested(active, preempting);
    if (active) {
      publishFeedback();
    }
  }

 private:
  enum class End { kNone, kBeingSet, kAborted, kCanceled, kSucceeded };

  void request(End end, ResultConstPtr& result) {
    End none = End::kNone;
    if (!end_.compare_exchange_strong(none, End::kBeingSet, std::memory_order_relaxed)) {
      return;
    }
    result_.swap(result);
    end_.store(end, std::memory_order_release);
  }

  void endAsRequested(bool active, bool preempting) {
    const End end = end_.load(std::memory_order_acquire);
    if (end == End::kAborted && (active || preempting)) {
      gh_.setAborted(resultOrEmpty());
    } else if (end == End::kCanceled && preempting) {
      gh_.setCanceled(resultOrEmpty());
    } else if (end == End::kSucceeded && (active || preempting)) {
      gh_.setSucceeded(resultOrEmpty());
    }
  }

  Result resultOrEmpty() const { return result_ ? *result_ : Result(); }

  void publishFeedback() {
    if (feedback_busy_.test_and_set(std::memory_order_acquire)) {
      return;
    }
    const FeedbackConstPtr feedback = feedback_;
    feedback_busy_.clear(std::memory_order_release);
    if (feedback) {
      gh_.publishFeedback(*feedback);
    }
  }

  std::atomic<End> end_{End::kNone};
  ResultConstPtr result_;  ///< belongs to the real-time thread until `end_` is set
  std::atomic_flag feedback_busy_ = ATOMIC_FLAG_INIT;
  FeedbackConstPtr feedback_;  ///< guarded by feedback_busy_
};

}  // namespace realtime_tools
