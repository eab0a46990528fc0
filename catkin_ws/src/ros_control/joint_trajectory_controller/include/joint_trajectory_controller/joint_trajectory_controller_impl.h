// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions of JointTrajectoryController that run in the control loop.

#include <joint_trajectory_controller/joint_trajectory_controller.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace joint_trajectory_controller {
namespace internal {

/// A number with six decimals, as %f of C, and a decimal point in every locale. Real-time safe.
struct FixedText {
  explicit FixedText(double value) noexcept {
    char* const end = text + sizeof(text) - 1;
    auto written = std::to_chars(text, end, value, std::chars_format::fixed, 6);
    if (written.ec != std::errc()) {  // too many digits
      written = std::to_chars(text, end, value);
    }
    *written.ptr = '\0';
  }
  char text[40];
};

}  // namespace internal

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::starting(const ros::Time& time) {
  // Commands for an earlier session are dropped.
  exchange_.giveBack(exchange_.take());
  exchange_.giveBack(command_);
  command_ = nullptr;

  time_data_ = TimeData{time, ros::Duration(0.0), ros::Time(0.0)};
  last_state_publish_time_ = time_data_.uptime;
  readMeasuredState();
  desired_state_.position = current_state_.position;
  desired_state_.velocity = current_state_.velocity;
  beginHold();
  sampleDesiredState();
  hw_iface_adapter_.starting(time);
  publishSnapshot();
  session_.fetch_add(1);
  running_.store(true);
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::stopping(const ros::Time& time) {
  running_.store(false);
  session_.fetch_add(1);
  hw_iface_adapter_.stopping(time);
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::update(
    const ros::Time& time, const ros::Duration& period) {
  time_data_.time = time;
  time_data_.period = std::max(period, ros::Duration(0.0));
  time_data_.uptime += time_data_.period;

  readMeasuredState();
  takeCommand();
  updateFuncExtensionPoint(trajectory(), time_data_);
  sampleDesiredState();
  if (!checkGoal()) {
    sampleDesiredState();
  }
  hw_iface_adapter_.updateCommand(time_data_.time, time_data_.period, desired_state_, state_error_);
  publishState();
  publishSnapshot();
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::readMeasuredState() {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    current_state_.position[i] = joints_[i].getPosition();
    current_state_.velocity[i] = joints_[i].getVelocity();
  }
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::takeCommand() {
  Command* const command = exchange_.take();
  if (command == nullptr) {
    return;
  }
  if (command->trajectory && (command->epoch != epoch_ || !join(*command))) {
    command->outdated = true;
    exchange_.giveBack(command);
    return;
  }
  follow(command);
}

/// Prepares the passage from the present motion to a trajectory. It was computed for a tick that
/// may be over by now, or to continue one that the loop never got: the difference then fades out
/// until the end of each joint's segment; of a joint that the trajectory leaves in place, until the
/// end of the others'. As splines add up, the joints move as if the trajectory had been computed in
/// this tick.
/// @returns false if a joint would have to jump, because the trajectory is already over.
template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::join(const Command& command) {
  sampleDesiredState();
  const auto differenceOf = [&](std::size_t joint) {
    const TrajectoryPerJoint& segments = (*command.trajectory)[joint];
    const auto found = trajectory_interface::sample(segments, uptime(), joint_state_);
    deviation_.position[0] = desired_state_.position[joint] - joint_state_.position[0];
    return found == segments.end() ? segments.front().endTime() : found->endTime();
  };
  Scalar last_end = uptime();
  bool differs = false;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    last_end = std::max(last_end, Scalar(differenceOf(i)));
    differs = differs || deviation_.position[0] != Scalar(0);
  }
  if (differs && last_end <= uptime()) {
    return false;
  }
  // A motion without velocities is linear, one without accelerations cubic: so is the passage.
  const trajectory_msgs::JointTrajectoryPoint& point = command.message->points.front();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Scalar end = differenceOf(i);
    deviation_.velocity.resize(point.velocities.empty() ? 0 : 1);
    deviation_.acceleration.resize(point.accelerations.empty() ? 0 : 1);
    if (!point.velocities.empty()) {
      deviation_.velocity[0] = desired_state_.velocity[i] - joint_state_.velocity[0];
    }
    if (!point.accelerations.empty()) {
      deviation_.acceleration[0] = desired_state_.acceleration[i] - joint_state_.acceleration[0];
    }
    deviations_[i].init(uptime(), deviation_, end > uptime() ? end : last_end, zero_);
  }
  return true;
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::follow(Command* command) {
  exchange_.giveBack(command_);
  command_ = command;
  std::fill(joint_succeeded_.begin(), joint_succeeded_.end(), 0);
  if (command->trajectory) {
    holding_ = false;
  } else {
    beginHold();
  }
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::beginHold() {
  hold_origin_.position =
      stop_trajectory_duration_ > 0 ? desired_state_.position : current_state_.position;
  hold_origin_.velocity = desired_state_.velocity;
  hold_start_ = uptime();
  hold_builder_->setStartTime(hold_start_)->buildTrajectory(&hold_trajectory_);
  std::for_each(deviations_.begin(), deviations_.end(),
                [this](SegmentImpl& deviation) { deviation.init(0, zero_, 0, zero_); });
  holding_ = true;
  ++epoch_;
}

/// The state of a joint by the present motion, in joint_state_. @returns its segment
template <class SegmentImpl, class HardwareInterface>
const typename JointTrajectoryController<SegmentImpl, HardwareInterface>::Segment&
JointTrajectoryController<SegmentImpl, HardwareInterface>::sampleJoint(std::size_t joint) {
  const TrajectoryPerJoint& segments = trajectory()[joint];
  const auto found = trajectory_interface::sample(segments, uptime(), joint_state_);
  if (uptime() < deviations_[joint].endTime()) {
    deviations_[joint].sample(uptime(), deviation_);
    joint_state_.position[0] += deviation_.position[0];
    joint_state_.velocity[0] += deviation_.velocity[0];
    joint_state_.acceleration[0] += deviation_.acceleration[0];
  }
  return found == segments.end() ? segments.front() : *found;
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::sampleDesiredState() {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    segments_[i] = &sampleJoint(i);
    desired_state_.position[i] = joint_state_.position[0];
    desired_state_.velocity[i] = joint_state_.velocity[0];
    desired_state_.acceleration[i] = joint_state_.acceleration[0];
    state_error_.position[i] =
        angle_wraparound_[i]
            ? shortestAngularDistance(current_state_.position[i], desired_state_.position[i])
            : desired_state_.position[i] - current_state_.position[i];
    state_error_.velocity[i] = desired_state_.velocity[i] - current_state_.velocity[i];
    state_error_.acceleration[i] = Scalar(0);
  }
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::checkGoal() {
  RealtimeGoal* const goal = command_ != nullptr ? command_->goal.get() : nullptr;
  if (goal == nullptr || !goal->isOpen()) {
    return true;
  }
  if (!command_->trajectory) {
    if (uptime() >= hold_start_ + stop_trajectory_duration_) {
      succeed(*goal);
    }
    return true;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!checkJointTolerance(i, *goal)) {
      beginHold();
      return false;
    }
  }
  if (std::all_of(joint_succeeded_.begin(), joint_succeeded_.end(),
                  [](char succeeded) { return succeeded != 0; })) {
    succeed(*goal);
  }
  return true;
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::checkJointTolerance(
    std::size_t joint, RealtimeGoal& goal) {
  const Segment& segment = *segments_[joint];
  if (segment.goalHandle() != goal.handle().get()) {
    return true;
  }
  const SegmentTolerancesPerJoint<Scalar>& tolerances = segment.getTolerances();
  if (uptime() < segment.endTime()) {
    if (isWithinTolerance(state_error_, joint, tolerances.state_tolerance)) {
      return true;
    }
    failGoal(goal, control_msgs::FollowJointTrajectoryResult::PATH_TOLERANCE_VIOLATED, joint,
             "path", tolerances.state_tolerance);
    return false;
  }
  if (&segment != &trajectory()[joint].back()) {
    return true;
  }
  if (isWithinTolerance(state_error_, joint, tolerances.goal_state_tolerance)) {
    joint_succeeded_[joint] = 1;
  } else if (!joint_succeeded_[joint] &&
             uptime() >= segment.endTime() + tolerances.goal_time_tolerance) {
    failGoal(goal, control_msgs::FollowJointTrajectoryResult::GOAL_TOLERANCE_VIOLATED, joint,
             "goal", tolerances.goal_state_tolerance);
    return false;
  }
  return true;
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::failGoal(
    RealtimeGoal& goal, int code, std::size_t joint, const char* kind,
    const StateTolerances<Scalar>& tolerance) {
  if (!goal.claim()) {
    return;
  }
  char text[kReasonCapacity];
  using internal::FixedText;
  const int length = std::snprintf(
      text, sizeof(text),
      "%s %s error %s (velocity error %s) is beyond the %s tolerance of %s (velocity %s; 0 means "
      "unchecked). The joints now hold their position.",
      joint_names_[joint].c_str(), kind, FixedText(state_error_.position[joint]).text,
      FixedText(state_error_.velocity[joint]).text, kind, FixedText(tolerance.position).text,
      FixedText(tolerance.velocity).text);
  // The string has sufficient capacity: see goalOf().
  control_msgs::FollowJointTrajectoryResult& result = *goal.handle()->preallocated_result_;
  result.error_string.assign(text, std::min<std::size_t>(std::max(length, 0), sizeof(text) - 1));
  result.error_code = code;
  goal.settle(RealtimeGoal::Outcome::kAborted);
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::succeed(RealtimeGoal& goal) {
  if (goal.claim()) {
    goal.handle()->preallocated_result_->error_code =
        control_msgs::FollowJointTrajectoryResult::SUCCESSFUL;
    goal.settle(RealtimeGoal::Outcome::kSucceeded);
  }
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::publishState() {
  if (state_publisher_period_.isZero() ||
      time_data_.uptime < last_state_publish_time_ + state_publisher_period_ ||
      !state_publisher_->trylock()) {
    return;
  }
  last_state_publish_time_ += state_publisher_period_;
  if (time_data_.uptime > last_state_publish_time_ + state_publisher_period_) {
    last_state_publish_time_ = time_data_.uptime;  // no burst after a gap
  }
  control_msgs::JointTrajectoryControllerState& msg = state_publisher_->msg_;
  const ros::Duration from_start(timeFromStart());
  msg.header.stamp = time_data_.time;
  msg.desired.positions = desired_state_.position;
  msg.desired.velocities = desired_state_.velocity;
  msg.desired.accelerations = desired_state_.acceleration;
  msg.desired.time_from_start = from_start;
  msg.actual.positions = current_state_.position;
  msg.actual.velocities = current_state_.velocity;
  msg.actual.time_from_start = from_start;
  msg.error.positions = state_error_.position;
  msg.error.velocities = state_error_.velocity;
  msg.error.time_from_start = from_start;
  state_publisher_->unlockAndPublish();
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::publishSnapshot() {
  Snapshot& draft = snapshot_.draft();
  draft.time = time_data_;
  draft.epoch = epoch_;
  draft.holding = holding_;
  draft.hold_start = hold_start_;
  draft.hold_origin = hold_origin_;
  draft.desired = desired_state_;
  draft.actual = current_state_;
  draft.error = state_error_;
  draft.time_from_start = timeFromStart();
  snapshot_.publish();
}

}  // namespace joint_trajectory_controller
