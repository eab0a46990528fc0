// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_trajectory_controller/joint_trajectory_msg_utils.h>
#include <joint_trajectory_controller/joint_trajectory_segment.h>
#include <ros/console.h>
#include <ros/time.h>
#include <trajectory_interface/trajectory_interface.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>
#include <cmath>
#include <ios>
#include <sstream>
#include <string>
#include <vector>

namespace joint_trajectory_controller {

/// Options of initJointTrajectory(); null pointers disable an option.
/// @tparam Trajectory a vector (joints) of vectors (time) of segments of one joint
template <class Trajectory>
struct InitJointTrajectoryOptions {
  typedef typename Trajectory::value_type TrajectoryPerJoint;  ///< of one joint
  typedef typename TrajectoryPerJoint::value_type Segment;     ///< a part of it
  typedef typename Segment::Scalar Scalar;                     ///< of positions
  typedef typename Segment::RealtimeGoalHandlePtr RealtimeGoalHandlePtr;

  Trajectory* current_trajectory{nullptr};                 ///< continued by the message
  std::vector<std::string>* joint_names{nullptr};          ///< order of joints in the result
  std::vector<bool>* angle_wraparound{nullptr};            ///< which joints are continuous
  RealtimeGoalHandlePtr rt_goal_handle;                    ///< goal of the new segments
  SegmentTolerances<Scalar>* default_tolerances{nullptr};  ///< defaults for the goal
  ros::Time* other_time_base{nullptr};    ///< `time` in the time base of the trajectories
  bool allow_partial_joints_goal{false};  ///< goals for some joints
  std::string* error_string{nullptr};     ///< gets the reason for an empty result

  /// Sets the reason, if the caller takes it.
  void setErrorString(const std::string& text) const {
    if (error_string != nullptr) {
      *error_string = text;
    }
  }
};

namespace internal {

/// The steps of initJointTrajectory().
template <class Trajectory>
class TrajectoryInitializer {
 public:
  typedef InitJointTrajectoryOptions<Trajectory> Options;
  typedef typename Options::TrajectoryPerJoint TrajectoryPerJoint;
  typedef typename Options::Segment Segment;
  typedef typename Options::Scalar Scalar;
  typedef typename Segment::State State;
  typedef std::vector<trajectory_msgs::JointTrajectoryPoint>::const_iterator PointIterator;

  TrajectoryInitializer(const trajectory_msgs::JointTrajectory& msg, const ros::Time& time,
                        const Options& options)
      : msg_(msg), time_(time), options_(options) {}

  Trajectory run() {
    if (!isUsable() || !selectJoints() || !selectPoints()) {
      return Trajectory();
    }
    const ros::Time base = options_.other_time_base ? *options_.other_time_base : time_;
    now_ = base.toSec();
    start_ = now_ + (startTime(msg_, time_) - time_).toSec();

    Trajectory result(joint_count_);
    for (std::size_t joint = 0; joint < joint_count_; ++joint) {
      const auto found = std::find(mapping_.begin(), mapping_.end(), joint);
      result[joint] = found == mapping_.end()
                          ? continued(joint)
                          : replaced(joint, std::size_t(found - mapping_.begin()));
    }
    return result;
  }

 private:
  bool refuse(const std::string& text) const {
    ROS_ERROR_STREAM(text);
    options_.setErrorString(text);
    return false;
  }

  bool isUsable() const {
    if (msg_.points.empty()) {
      const std::string text = "Trajectory message contains empty trajectory. Nothing to convert.";
      ROS_DEBUG_STREAM(text);
      options_.setErrorString(text);
      return false;
    }
    if (!isTimeStrictlyIncreasing(msg_)) {
      return refuse(
          "Trajectory message contains waypoints that are not strictly increasing in time.");
    }
    for (const trajectory_msgs::JointTrajectoryPoint& point : msg_.points) {
      // If the message names no joints, a point's positions define their number. Positions beyond
      // the named joints are not read.
      const std::size_t size = point.positions.size();
      const bool fits = msg_.joint_names.empty() ? size == msg_.points[0].positions.size()
                                                 : size >= msg_.joint_names.size();
      if (size == 0 || !fits || !isValid(point, static_cast<unsigned int>(size))) {
        throw std::invalid_argument(
            "Size mismatch in trajectory point position, velocity or acceleration data.");
      }
      if (!isFinite(point.positions) || !isFinite(point.velocities) ||
          !isFinite(point.accelerations)) {
        return refuse("Trajectory message contains numbers that are not finite.");
      }
    }
    return true;
  }

  bool selectJoints() {
    const std::vector<std::string>& names =
        options_.joint_names ? *options_.joint_names : msg_.joint_names;
    joint_count_ = names.empty() ? msg_.points[0].positions.size() : names.size();
    if (joint_count_ == 0) {
      return refuse("Cannot create trajectory from message. It does not contain any joints.");
    }
    if (options_.angle_wraparound && options_.angle_wraparound->size() != joint_count_) {
      return refuse(
          "Cannot create trajectory from message. Vector specifying whether joints wrap "
          "around has an invalid size.");
    }
    if (names.empty()) {
      for (std::size_t i = 0; i < joint_count_; ++i) {
        mapping_.push_back(static_cast<unsigned int>(i));
      }
    } else {
      mapping_ = mapping(msg_.joint_names, names);
    }
    const bool complete = mapping_.size() == joint_count_;
    const bool partial = options_.allow_partial_joints_goal && !mapping_.empty();
    if (!complete && !partial) {
      return refuse(
          "Cannot create trajectory from message. It does not contain the expected joints.");
    }
    const Trajectory* current = options_.current_trajectory;
    const bool has_current =
        current && current->size() == joint_count_ &&
        std::none_of(current->begin(), current->end(),
                     [](const TrajectoryPerJoint& joint) { return joint.empty(); });
    if ((current || !complete) && !has_current) {
      return refuse(
          "Cannot create trajectory from message. The current trajectory does not have "
          "the expected joints.");
    }
    return true;
  }

  /// Drops past points.
  bool selectPoints() {
    const PointIterator past = findPoint(msg_, time_);
    first_point_ = past == msg_.points.end() ? msg_.points.begin() : past + 1;
    const auto dropped = std::size_t(first_point_ - msg_.points.begin());
    if (first_point_ == msg_.points.end()) {
      const ros::Duration since =
          time_ - (startTime(msg_, time_) + msg_.points.back().time_from_start);
      std::ostringstream text;
      text << "Dropping all " << msg_.points.size()
           << " trajectory point(s), as they occur before the current time.\nLast point is "
           << std::fixed << since.toSec() << "s in the past.";
      ROS_WARN_STREAM(text.str());
      options_.setErrorString(text.str());
      return false;
    }
    if (options_.current_trajectory == nullptr && first_point_ + 1 == msg_.points.end()) {
      return refuse(
          "Cannot create trajectory from message. One point that is not in the past makes no "
          "trajectory without a current one that leads to it.");
    }
    // Planners start with the present state; dropping only that one is normal.
    const bool expected =
        dropped == 1 && msg_.header.stamp.isZero() && msg_.points[0].time_from_start.isZero();
    if (dropped > 0 && !expected) {
      ROS_WARN_STREAM("Dropping first " << dropped << " trajectory point(s) out of "
                                        << msg_.points.size()
                                        << ", as they occur before the current time.");
    }
    return true;
  }

  /// A joint that the message does not name continues as before, now for the new goal.
  TrajectoryPerJoint continued(std::size_t joint) const {
    const TrajectoryPerJoint& current = (*options_.current_trajectory)[joint];
    auto first = trajectory_interface::findSegment(current, now_);
    if (first == current.end()) {
      first = current.begin();
    }
    TrajectoryPerJoint result(first, current.end());
    for (Segment& segment : result) {
      segment.setGoalHandle(options_.rt_goal_handle);
    }
    return result;
  }

  TrajectoryPerJoint replaced(std::size_t joint, std::size_t index) const {
    TrajectoryPerJoint result;
    const SegmentTolerancesPerJoint<Scalar> tolerances = tolerancesOf(joint);
    Scalar offset = 0;
    if (options_.current_trajectory) {
      offset = bridge(joint, index, tolerances, result);
    }
    for (PointIterator point = first_point_; point + 1 != msg_.points.end(); ++point) {
      append(timeOf(*point), stateOf(*point, index, offset), timeOf(*(point + 1)),
             stateOf(*(point + 1), index, offset), tolerances, result);
    }
    return result;
  }

  /// Keeps the current trajectory until the message starts and moves from there to its first point.
  /// @return the wraparound offset of the positions in the message
  Scalar bridge(std::size_t joint, std::size_t index,
                const SegmentTolerancesPerJoint<Scalar>& tolerances,
                TrajectoryPerJoint& result) const {
    const TrajectoryPerJoint& current = (*options_.current_trajectory)[joint];
    const Scalar arrival = timeOf(*first_point_);
    const bool wraps = options_.angle_wraparound && (*options_.angle_wraparound)[joint];
    Scalar departure = std::max(start_, now_);
    State from = stateAt(current, departure);
    Scalar offset = offsetOf(from, index, wraps);
    // A first point at the start of a later message leaves no time to reach it. Unless the current
    // trajectory passes through it, the motion to it starts now, instead of a jump.
    if (departure >= arrival && jumps(from, stateOf(*first_point_, index, offset))) {
      departure = now_;
      from = stateAt(current, departure);
      offset = offsetOf(from, index, wraps);
    }
    result.assign(segmentAt(current, now_), segmentAt(current, departure) + 1);
    append(departure, from, arrival, stateOf(*first_point_, index, offset), tolerances, result);
    return offset;
  }

  static typename TrajectoryPerJoint::const_iterator segmentAt(const TrajectoryPerJoint& trajectory,
                                                               Scalar time) {
    const auto found = trajectory_interface::findSegment(trajectory, time);
    return found == trajectory.end() ? trajectory.begin() : found;
  }

  static State stateAt(const TrajectoryPerJoint& trajectory, Scalar time) {
    State state;
    segmentAt(trajectory, time)->sample(time, state);
    return state;
  }

  Scalar offsetOf(const State& from, std::size_t index, bool wraps) const {
    return wraparoundJointOffset(from.position[0], Scalar(first_point_->positions[index]), wraps);
  }

  /// Whether continuing from one state to the other without time in between is noticeable.
  ///
  /// At 1 kHz, steps of this size are accelerations of 1 rad/s^2 each, and jerks of at most 3000
  /// rad/s^3 together: below the smallest limits of a Panda's joints, 7.5 rad/s^2 and 3750 rad/s^3.
  /// Rounding in a planner's copy of our own states is far smaller.
  static bool jumps(const State& from, const State& to) {
    constexpr Scalar kPositionStep = 1e-6;  // [rad]
    constexpr Scalar kVelocityStep = 1e-3;  // [rad/s]
    return std::abs(to.position[0] - from.position[0]) > kPositionStep ||
           (!to.velocity.empty() && std::abs(to.velocity[0] - from.velocity[0]) > kVelocityStep);
  }

  void append(Scalar start_time, const State& start, Scalar end_time, const State& end,
              const SegmentTolerancesPerJoint<Scalar>& tolerances,
              TrajectoryPerJoint& result) const {
    Segment segment(start_time, start, end_time, end);
    segment.setGoalHandle(options_.rt_goal_handle);
    if (options_.rt_goal_handle) {
      segment.setTolerances(tolerances);
    }
    result.push_back(segment);
  }

  Scalar timeOf(const trajectory_msgs::JointTrajectoryPoint& point) const {
    return start_ + point.time_from_start.toSec();
  }

  static State stateOf(const trajectory_msgs::JointTrajectoryPoint& point, std::size_t index,
                       Scalar offset) {
    State state;
    state.position = {Scalar(point.positions[index]) + offset};
    if (!point.velocities.empty()) {
      state.velocity = {Scalar(point.velocities[index])};
    }
    if (!point.accelerations.empty()) {
      state.acceleration = {Scalar(point.accelerations[index])};
    }
    state.time_from_start = point.time_from_start.toSec();
    return state;
  }

  SegmentTolerancesPerJoint<Scalar> tolerancesOf(std::size_t joint) const {
    SegmentTolerancesPerJoint<Scalar> result;
    if (!options_.rt_goal_handle || !options_.default_tolerances) {
      return result;
    }
    SegmentTolerances<Scalar> all = *options_.default_tolerances;
    const auto goal = options_.rt_goal_handle->gh_.getGoal();
    if (goal && options_.joint_names) {
      updateSegmentTolerances(*goal, *options_.joint_names, all);
    }
    result.state_tolerance = all.state_tolerance[joint];
    result.goal_state_tolerance = all.goal_state_tolerance[joint];
    result.goal_time_tolerance = all.goal_time_tolerance;
    return result;
  }

  const trajectory_msgs::JointTrajectory& msg_;
  const ros::Time time_;
  const Options& options_;
  std::size_t joint_count_{0};
  std::vector<unsigned int> mapping_;  ///< from joints of the message to those of the result
  PointIterator first_point_;
  Scalar now_{0};    ///< `time_` in the time base of the trajectories [s]
  Scalar start_{0};  ///< start of the message, likewise
};

}  // namespace internal

/// Converts a message into a trajectory, spliced to the current one.
///
/// Points at or before `time` are dropped. Without a current trajectory the result starts at the
/// first remaining point, and two of them are needed. With one, each joint keeps its current
/// trajectory until the message starts, then moves in one segment to the first remaining point. A
/// first point at the very start of a later message is the joint's position at that time: a joint
/// whose current trajectory passes through it keeps that trajectory; otherwise it leaves it at
/// once, instead of jumping.
///
/// @param time now, in the time base of the message
/// @returns an empty trajectory, with a reason in the log and in the options' error string, if
/// there is nothing to do or the message is invalid. @throws std::invalid_argument if a point has
/// fewer positions than the message has joints, or velocities or accelerations of another number;
/// positions beyond the last joint are not read.
/// Not real-time safe.
template <class Trajectory>
Trajectory initJointTrajectory(const trajectory_msgs::JointTrajectory& msg, const ros::Time& time,
                               const InitJointTrajectoryOptions<Trajectory>& options =
                                   InitJointTrajectoryOptions<Trajectory>()) {
  return internal::TrajectoryInitializer<Trajectory>(msg, time, options).run();
}

}  // namespace joint_trajectory_controller
