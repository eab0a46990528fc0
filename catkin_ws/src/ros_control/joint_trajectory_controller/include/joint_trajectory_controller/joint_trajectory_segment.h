// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <angles/angles.h>  // for clients, which find it through this header
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <joint_trajectory_controller/tolerances.h>
#include <realtime_tools/realtime_server_goal_handle.h>
#include <ros/time.h>
#include <trajectory_msgs/JointTrajectoryPoint.h>

#include <boost/shared_ptr.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace joint_trajectory_controller {

/// A segment of a trajectory, with its goal and that goal's tolerances.
/// @tparam Segment a segment type such as trajectory_interface::QuinticSplineSegment
template <class Segment>
class JointTrajectorySegment : public Segment {
 public:
  typedef typename Segment::Scalar Scalar;  ///< of positions
  typedef typename Segment::Time Time;      ///< [s]
  typedef realtime_tools::RealtimeServerGoalHandle<control_msgs::FollowJointTrajectoryAction>
      RealtimeGoalHandle;
  typedef boost::shared_ptr<RealtimeGoalHandle> RealtimeGoalHandlePtr;

  /// A state of the joints, made from a point of a message.
  struct State : public Segment::State {
    typedef typename Segment::State::Scalar Scalar;  ///< of positions
    State() = default;
    State(unsigned int size) : Segment::State(size) {}
    /// Like init().
    State(const trajectory_msgs::JointTrajectoryPoint& point,
          const std::vector<Scalar>& position_offset = {}) {
      init(point, position_offset);
    }

    /// Copies a point of a message, in the order of its joints.
    /// @param position_offset added to the positions, one per joint; empty: none.
    /// @throws std::invalid_argument if sizes do not match.
    void init(const trajectory_msgs::JointTrajectoryPoint& point,
              const std::vector<Scalar>& position_offset = {}) {
      const std::size_t size = point.positions.size();
      const auto fits = [size](std::size_t other) { return other == 0 || other == size; };
      if (!fits(point.velocities.size()) || !fits(point.accelerations.size())) {
        throw std::invalid_argument(
            "Size mismatch in trajectory point position, velocity or acceleration data.");
      }
      if (!fits(position_offset.size())) {
        throw std::invalid_argument("Size mismatch between trajectory point and position offset.");
      }
      this->position.assign(point.positions.begin(), point.positions.end());
      this->velocity.assign(point.velocities.begin(), point.velocities.end());
      this->acceleration.assign(point.accelerations.begin(), point.accelerations.end());
      for (std::size_t i = 0; i < position_offset.size(); ++i) {
        this->position[i] += position_offset[i];
      }
      this->time_from_start = static_cast<Scalar>(point.time_from_start.toSec());
    }
  };

  JointTrajectorySegment() = default;
  JointTrajectorySegment(const Time& start_time, const State& start_state, const Time& end_time,
                         const State& end_state)
      : Segment(start_time, start_state, end_time, end_state) {}
  /// Between two points of a message.
  /// @param traj_start_time start of the message, to which the points' times refer. The segment has
  /// the same time base.
  /// @param position_offset added to the positions of both points; empty: none.
  /// @throws std::invalid_argument like State::init() and Segment.
  JointTrajectorySegment(const ros::Time& traj_start_time,
                         const trajectory_msgs::JointTrajectoryPoint& start_point,
                         const trajectory_msgs::JointTrajectoryPoint& end_point,
                         const std::vector<Scalar>& position_offset = {})
      : Segment(Time((traj_start_time + start_point.time_from_start).toSec()),
                State(start_point, position_offset),
                Time((traj_start_time + end_point.time_from_start).toSec()),
                State(end_point, position_offset)) {}

  /// The goal that the segment belongs to.
  RealtimeGoalHandlePtr getGoalHandle() const { return goal_handle_; }
  /// The same without shared ownership, for the control loop.
  RealtimeGoalHandle* goalHandle() const noexcept { return goal_handle_.get(); }
  /// Sets the goal that the segment belongs to.
  void setGoalHandle(const RealtimeGoalHandlePtr& goal_handle) { goal_handle_ = goal_handle; }

  /// @name The tolerances of the segment
  /// @{
  const SegmentTolerancesPerJoint<Scalar>& getTolerances() const { return tolerances_; }
  void setTolerances(const SegmentTolerancesPerJoint<Scalar>& tolerances) {
    tolerances_ = tolerances;
  }
  /// @}

 private:
  RealtimeGoalHandlePtr goal_handle_;
  SegmentTolerancesPerJoint<Scalar> tolerances_;
};

/// Difference of two angles on the shorter turn, in [-pi, pi]. Real-time safe.
template <class Scalar>
Scalar shortestAngularDistance(Scalar from, Scalar to) {
  return std::remainder(to - from, Scalar(2 * M_PI));
}

/// Offset for the next position of a joint so that it is at most half a turn from the previous one
/// [rad]; 0 unless `angle_wraparound`. A half turn keeps the direction of the positions.
template <class Scalar>
Scalar wraparoundJointOffset(const Scalar& prev_position, const Scalar& next_position,
                             const bool& angle_wraparound) {
  if (!angle_wraparound) {
    return Scalar(0);
  }
  Scalar distance = shortestAngularDistance(prev_position, next_position);
  if (std::abs(std::abs(distance) - M_PI) < 1e-9) {
    distance = std::copysign(distance, next_position - prev_position);
  }
  return (prev_position + distance) - next_position;
}

}  // namespace joint_trajectory_controller
