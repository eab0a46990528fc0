// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions of JointTrajectoryController that run in callbacks, under its mutex.

#include <joint_trajectory_controller/joint_trajectory_controller.h>

#include <algorithm>
#include <exception>
#include <thread>

namespace joint_trajectory_controller {

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::updateTrajectoryCommand(
    const JointTrajectoryConstPtr& msg, RealtimeGoalHandlePtr gh, std::string* error_string) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  if (!msg) {
    return false;
  }
  const std::uint64_t session = session_.load();
  if (!running_.load()) {
    const std::string text = "Can't accept new commands. Controller is not running.";
    ROS_ERROR_STREAM_NAMED(name_, text);
    if (error_string != nullptr) {
      *error_string = text;
    }
    return false;
  }
  if (msg->points.empty()) {
    putHold(msg, goalOf(gh));
    return true;
  }

  const Snapshot& snapshot = snapshot_.read();
  // The loop will get the command in its next update at the earliest.
  const ros::Time next_time = snapshot.time.time + snapshot.time.period;
  ros::Time next_uptime = snapshot.time.uptime + snapshot.time.period;
  Trajectory current = callbackTrajectory(snapshot);

  InitJointTrajectoryOptions<Trajectory> options;
  options.current_trajectory = &current;
  options.joint_names = &joint_names_;
  options.angle_wraparound = &angle_wraparound_;
  options.rt_goal_handle = gh;
  options.default_tolerances = &default_tolerances_;
  options.other_time_base = &next_uptime;
  options.allow_partial_joints_goal = allow_partial_joints_goal_;
  options.error_string = error_string;
  try {
    auto command = std::make_unique<Command>();
    command->trajectory =
        std::make_shared<Trajectory>(initJointTrajectory<Trajectory>(*msg, next_time, options));
    if (command->trajectory->empty()) {
      return false;
    }
    command->goal = latest_goal_ = goalOf(gh);
    command->message = msg;
    command->start =
        next_uptime.toSec() + (internal::startTime(*msg, next_time) - next_time).toSec();
    command->epoch = snapshot.epoch;
    command->session = session;
    command->number = ++number_;
    latest_trajectory_ = command->trajectory;
    latest_epoch_ = snapshot.epoch;
    exchange_.put(std::move(command));
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM_NAMED(name_, error.what());
    options.setErrorString(error.what());
    return false;
  }
  return true;
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::putHold(
    const JointTrajectoryConstPtr& msg, const RealtimeGoalPtr& goal) {
  auto command = std::make_unique<Command>();
  command->goal = latest_goal_ = goal;
  command->message = msg;
  command->session = session_.load();
  command->number = ++number_;
  latest_trajectory_.reset();
  exchange_.put(std::move(command));
}

/// The goal of a handle: an existing one is reused, because a command may be computed again.
template <class SegmentImpl, class HardwareInterface>
typename JointTrajectoryController<SegmentImpl, HardwareInterface>::RealtimeGoalPtr
JointTrajectoryController<SegmentImpl, HardwareInterface>::goalOf(
    const RealtimeGoalHandlePtr& handle) const {
  if (!handle) {
    return nullptr;
  }
  if (latest_goal_ && latest_goal_->handle() == handle) {
    return latest_goal_;
  }
  handle->preallocated_result_->error_string.reserve(kReasonCapacity);
  return std::make_shared<RealtimeGoal>(handle);
}

/// The trajectory that the loop follows, or will follow after the last command: a new trajectory
/// continues it.
template <class SegmentImpl, class HardwareInterface>
typename JointTrajectoryController<SegmentImpl, HardwareInterface>::Trajectory
JointTrajectoryController<SegmentImpl, HardwareInterface>::callbackTrajectory(
    const Snapshot& snapshot) {
  if (latest_trajectory_ && latest_epoch_ == snapshot.epoch) {
    return *latest_trajectory_;
  }
  if (snapshot.holding) {
    return holdTrajectory(snapshot.hold_start, snapshot.hold_origin);
  }
  // The last command is hold, but the loop has not executed it yet.
  return holdTrajectory(snapshot.time.uptime.toSec(),
                        stop_trajectory_duration_ > 0 ? snapshot.desired : snapshot.actual);
}

/// The result of the loop's hold builder at `start` [s] for a state, without reading the joints.
template <class SegmentImpl, class HardwareInterface>
typename JointTrajectoryController<SegmentImpl, HardwareInterface>::Trajectory
JointTrajectoryController<SegmentImpl, HardwareInterface>::holdTrajectory(
    double start, const State& origin) const {
  Trajectory result;
  if (stop_trajectory_duration_ > 0) {
    StopBuilder(stop_trajectory_duration_, origin).setStartTime(start)->buildTrajectory(&result);
    return result;
  }
  State state(1);
  result.assign(origin.position.size(), TrajectoryPerJoint(1));
  for (std::size_t i = 0; i < result.size(); ++i) {
    internal::setHold(Scalar(start), origin.position[i], state, result[i][0]);
  }
  return result;
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::trajectoryCommandCB(
    const JointTrajectoryConstPtr& msg) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  if (updateTrajectoryCommand(msg, RealtimeGoalHandlePtr())) {
    preemptActiveGoal();
  }
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::checkJoints(
    const trajectory_msgs::JointTrajectory& msg, std::string& reason) const {
  const auto named = [&msg](const std::string& joint) {
    return std::count(msg.joint_names.begin(), msg.joint_names.end(), joint);
  };
  for (const std::string& joint : msg.joint_names) {
    if (std::find(joint_names_.begin(), joint_names_.end(), joint) == joint_names_.end()) {
      reason = "The goal names '" + joint + "', which is not a joint of the controller '" + name_ +
               "'. Its joints are";
      for (const std::string& own : joint_names_) {
        reason += " " + own;
      }
      reason += ".";
      return false;
    }
    if (named(joint) > 1) {
      reason = "The goal names the joint '" + joint + "' more than once.";
      return false;
    }
  }
  std::string missing;
  for (const std::string& own : joint_names_) {
    missing += named(own) == 0 ? " " + own : "";
  }
  if (msg.joint_names.empty() || (!missing.empty() && !allow_partial_joints_goal_)) {
    reason = "The goal lacks joints of the controller '" + name_ + "':" + missing +
             ". Name them all, or set the controller's parameter allow_partial_joints_goal.";
    return false;
  }
  return true;
}

/// Why commands for the joints have no effect; empty if they have one.
template <class SegmentImpl, class HardwareInterface>
std::string JointTrajectoryController<SegmentImpl, HardwareInterface>::reasonWithoutEffect() const {
  for (const hardware_interface::CommandEffectHandle& effect : effects_) {
    const std::string reason = effect.reasonWithoutEffect();
    if (!reason.empty()) {
      return reason;
    }
  }
  return "";
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::goalCB(GoalHandle gh) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  control_msgs::FollowJointTrajectoryResult result;
  const auto reject = [&](int code) {
    ROS_ERROR_STREAM_NAMED(name_, "Goal rejected: " << result.error_string);
    result.error_code = code;
    gh.setRejected(result, result.error_string);
  };
  if (!running_.load()) {
    result.error_string = "Can't accept new commands. Controller is not running.";
    reject(control_msgs::FollowJointTrajectoryResult::INVALID_GOAL);
    return;
  }
  result.error_string = reasonWithoutEffect();
  if (!result.error_string.empty()) {
    reject(control_msgs::FollowJointTrajectoryResult::INVALID_GOAL);
    return;
  }
  const std::uint64_t session = session_.load();
  const auto goal_message = gh.getGoal();
  if (!checkJoints(goal_message->trajectory, result.error_string)) {
    reject(control_msgs::FollowJointTrajectoryResult::INVALID_JOINTS);
    return;
  }
  const RealtimeGoalHandlePtr goal(new RealtimeGoalHandle(gh));
  const JointTrajectoryConstPtr msg(goal_message, &goal_message->trajectory);
  if (!updateTrajectoryCommand(msg, goal, &result.error_string)) {
    reject(control_msgs::FollowJointTrajectoryResult::INVALID_GOAL);
    return;
  }
  preemptActiveGoal();
  gh.setAccepted();
  active_goal_ = goalOf(goal);
  active_goal_session_ = session;
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::cancelCB(GoalHandle gh) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  if (!active_goal_ || !(active_goal_->handle()->gh_ == gh)) {
    return;
  }
  if (active_goal_->isOpen() && running_.load()) {
    putHold(JointTrajectoryConstPtr(), nullptr);
  }
  cancelActiveGoal("The client canceled the goal. The joints now hold their position.");
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::preemptActiveGoal() {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  cancelActiveGoal("Another command replaced this goal.");
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::cancelActiveGoal(
    const std::string& reason) {
  if (active_goal_) {
    endGoal(*active_goal_, RealtimeGoal::Outcome::kCanceled,
            control_msgs::FollowJointTrajectoryResult::SUCCESSFUL, reason);
    active_goal_.reset();
  }
}

/// Ends a goal unless the loop has just ended it, and reports the result to the client.
template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::endGoal(
    RealtimeGoal& goal, typename RealtimeGoal::Outcome outcome, int code,
    const std::string& reason) {
  control_msgs::FollowJointTrajectoryResult& result = *goal.handle()->preallocated_result_;
  if (goal.claim()) {
    result.error_code = code;
    result.error_string = reason;
    goal.settle(outcome);
  }
  // Between claim() and settle() of the loop there is no result yet; this takes a microsecond.
  while (!goal.isSettled()) {
    std::this_thread::yield();
  }
  goal.runNonRealtime(result.error_string);
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::monitor(
    const ros::WallTimerEvent& /*event*/) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  exchange_.collect([this](std::unique_ptr<Command> command) {
    if (command->outdated) {
      reissue(*command);
    }
  });
  if (!active_goal_) {
    return;
  }
  if (active_goal_->isSettled()) {
    active_goal_->runNonRealtime(active_goal_->handle()->preallocated_result_->error_string);
    active_goal_.reset();
  } else if (active_goal_session_ != session_.load()) {
    cancelActiveGoal("The controller '" + name_ + "' was stopped before the goal was reached.");
  } else {
    publishFeedback();
  }
}

/// Computes a command again that the loop found outdated.
template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::reissue(const Command& command) {
  const bool replaced = command.number != number_ || command.session != session_.load();
  if (replaced || (command.goal && !command.goal->isOpen())) {
    return;
  }
  std::string error;
  const RealtimeGoalHandlePtr handle =
      command.goal ? command.goal->handle() : RealtimeGoalHandlePtr();
  if (!updateTrajectoryCommand(command.message, handle, &error) && command.goal &&
      command.goal == active_goal_) {
    endGoal(*active_goal_, RealtimeGoal::Outcome::kAborted,
            control_msgs::FollowJointTrajectoryResult::INVALID_GOAL, error);
    active_goal_.reset();
  }
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::publishFeedback() {
  const Snapshot& snapshot = snapshot_.read();
  control_msgs::FollowJointTrajectoryFeedback feedback;
  const auto fill = [&](const State& state, trajectory_msgs::JointTrajectoryPoint& point) {
    point.positions = state.position;
    point.velocities = state.velocity;
    point.time_from_start = ros::Duration(snapshot.time_from_start);
  };
  feedback.header.stamp = snapshot.time.time;
  feedback.joint_names = joint_names_;
  fill(snapshot.desired, feedback.desired);
  feedback.desired.accelerations = snapshot.desired.acceleration;
  fill(snapshot.actual, feedback.actual);
  fill(snapshot.error, feedback.error);
  active_goal_->handle()->gh_.publishFeedback(feedback);
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::queryStateService(
    control_msgs::QueryTrajectoryState::Request& req,
    control_msgs::QueryTrajectoryState::Response& resp) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  if (!running_.load()) {
    ROS_ERROR_STREAM_NAMED(name_, "Can't sample trajectory. Controller is not running.");
    return false;
  }
  const Snapshot& snapshot = snapshot_.read();
  // In seconds, because differences of ros::Time overflow for distant times.
  const double time =
      snapshot.time.uptime.toSec() + (req.time.toSec() - snapshot.time.time.toSec());
  const Trajectory trajectory = callbackTrajectory(snapshot);
  resp.name = joint_names_;
  State state(1);
  for (const TrajectoryPerJoint& joint : trajectory) {
    if (trajectory_interface::sample(joint, Scalar(time), state) == joint.end()) {
      ROS_ERROR_STREAM_NAMED(name_, "Requested sample time precedes trajectory start time.");
      return false;
    }
    resp.position.push_back(state.position[0]);
    resp.velocity.push_back(state.velocity[0]);
    resp.acceleration.push_back(state.acceleration[0]);
  }
  return true;
}

}  // namespace joint_trajectory_controller
