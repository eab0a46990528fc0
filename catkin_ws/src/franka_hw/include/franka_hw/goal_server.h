// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/action_server.h>
#include <realtime_tools/own_callbacks.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

namespace franka_hw {

/// An action whose goals run one at a time, in a thread of the server: the newest goal ends the one
/// that runs and replaces the one that waits. Like actionlib::SimpleActionServer, with two
/// differences. Goals are ordered by their arrival, not by their stamps: after a clock that jumped
/// back, stamps would cancel every goal. And a goal that cannot be carried out is aborted at its
/// arrival, so that it ends no other goal.
///
/// Thread-safe. Not real-time safe.
template <class Action>
class GoalServer {
 public:
  /// The message of a goal.
  using Goal = typename Action::_action_goal_type::_goal_type;
  /// The message of its result.
  using Result = typename Action::_action_result_type::_result_type;
  /// Carries out a goal. It must end it with one of the setters.
  using CarryOut = std::function<void(const Goal&)>;
  /// @returns why the goal cannot be carried out, or an empty string; may fill the result of such a
  /// goal. Called at the goal's arrival, in the thread of the callbacks; must not wait
  using Check = std::function<std::string(const Goal&, Result&)>;

  /// @param name of the action in the namespace of node
  GoalServer(
      const ros::NodeHandle& node, const std::string& name, CarryOut carry_out,
      Check check = [](const Goal& /*goal*/, Result& /*result*/) { return ""; })
      : name_(node.resolveName(name)),
        carry_out_(std::move(carry_out)),
        check_(std::move(check)),
        server_(
            callbacks_.of(node), name, [this](Handle handle) { arrive(handle); },
            [this](Handle handle) { cancel(handle); }, false) {}
  ~GoalServer() {
    shutdown();
    callbacks_.stop();  // a status that is published in the destructor ends the process
  }
  GoalServer(const GoalServer&) = delete;
  GoalServer& operator=(const GoalServer&) = delete;

  /// Begins to accept goals.
  void start() {
    thread_ = std::thread([this] { run(); });
    server_.start();
    callbacks_.start();
  }

  /// Waits for the end of the goal that runs. The waiting goal and later ones are canceled. Must
  /// not be called by the function that carries out goals.
  void shutdown() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
      cancelNext("The server of the action shuts down.");
    }
    wake_.notify_all();
    if (thread_.joinable()) {
      thread_.join();
    }
  }

  /// Ends the goal that runs; like the setters below, only while it is carried out.
  void setSucceeded(const Result& result = {}, const std::string& text = "") {
    end([&](Handle& goal) { goal.setSucceeded(result, text); });
  }
  /// Ends it without success. @param text says why
  void setAborted(const Result& result = {}, const std::string& text = "") {
    end([&](Handle& goal) { goal.setAborted(result, text); });
  }
  /// Ends it because of isPreemptRequested().
  void setPreempted(const Result& result = {}, const std::string& text = "") {
    end([&](Handle& goal) { goal.setCanceled(result, text); });
  }

  /// Whether it is to end: a client canceled it, or a new goal waits.
  bool isPreemptRequested() const noexcept { return preempt_requested_; }
  /// Whether a new goal waits for its end.
  bool isNewGoalAvailable() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return has_next_;
  }

 private:
  using Handle = typename actionlib::ActionServer<Action>::GoalHandle;

  void arrive(Handle& goal) {
    Result result;
    const std::string fault = check_(*goal.getGoal(), result);
    if (!fault.empty()) {
      goal.setAccepted();
      goal.setAborted(result, fault);
      ROS_ERROR_STREAM(name_ << ": " << fault);
      return;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    cancelNext("A newer goal replaced this one before it began.");
    next_ = goal;
    has_next_ = true;
    if (ending_) {
      cancelNext("The server of the action shuts down.");
      return;
    }
    preempt_requested_ = runs_;
    wake_.notify_all();
  }

  void cancel(Handle& goal) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (has_next_ && goal == next_) {
      cancelNext("The goal was canceled before it began.");
    } else if (runs_ && goal == current_) {
      preempt_requested_ = true;
    }
  }

  void cancelNext(const char* reason) {
    if (has_next_) {
      has_next_ = false;
      next_.setCanceled(Result(), reason);
    }
  }

  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return ending_ || has_next_; });
      if (ending_) {
        return;
      }
      current_ = next_;
      has_next_ = false;
      runs_ = true;
      preempt_requested_ = false;
      current_.setAccepted();
      lock.unlock();
      carry_out_(*current_.getGoal());
      lock.lock();
      if (runs_) {
        runs_ = false;
        current_.setAborted(Result(), "The server did not say how this goal ended.");
      }
    }
  }

  // A new goal, or a cancel, that arrives meanwhile waits for the end.
  template <class End>
  void end(const End& end) {
    const std::lock_guard<std::mutex> lock(mutex_);
    runs_ = false;
    end(current_);
  }

  const std::string name_;
  const CarryOut carry_out_;
  const Check check_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Handle current_, next_;
  bool has_next_{false};
  bool runs_{false};  // until its end was sent
  bool ending_{false};
  std::atomic<bool> preempt_requested_{false};
  std::thread thread_;
  realtime_tools::OwnCallbacks callbacks_;
  actionlib::ActionServer<Action> server_;
};

}  // namespace franka_hw
