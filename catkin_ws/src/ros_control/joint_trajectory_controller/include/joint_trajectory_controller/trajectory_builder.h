// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_trajectory_controller/joint_trajectory_segment.h>

#include <boost/optional.hpp>
#include <vector>

namespace joint_trajectory_controller {

/// Builds trajectories of one kind. Set the start time before each.
///
///     builder.setStartTime(time)->setGoalHandle(goal)->buildTrajectory(&trajectory);
template <class SegmentImpl>
class TrajectoryBuilder {
 public:
  typedef JointTrajectorySegment<SegmentImpl> Segment;
  typedef std::vector<Segment> TrajectoryPerJoint;
  typedef std::vector<TrajectoryPerJoint> Trajectory;
  typedef typename Segment::Time Time;                              ///< [s]
  typedef typename Segment::RealtimeGoalHandle RealtimeGoalHandle;  ///< of the goal that it serves
  typedef typename Segment::RealtimeGoalHandlePtr RealtimeGoalHandlePtr;

  virtual ~TrajectoryBuilder() = default;

  /// @param start_time of the next trajectories, in their time base [s]. Real-time safe.
  TrajectoryBuilder* setStartTime(const Time& start_time) {
    start_time_ = start_time;
    return this;
  }
  /// @param goal_handle pointer to the goal of the next trajectories' segments, read by each
  /// buildTrajectory(): it must outlive them or the next reset(). Null for none. Real-time safe.
  TrajectoryBuilder* setGoalHandle(const RealtimeGoalHandlePtr& goal_handle) {
    goal_handle_ = &goal_handle;
    return this;
  }
  TrajectoryBuilder* setGoalHandle(const RealtimeGoalHandlePtr&& goal_handle) = delete;
  /// Resets the start time and the goal handle. Real-time safe.
  virtual void reset() {
    start_time_ = boost::none;
    goal_handle_ = nullptr;
  }

  /// Overwrites a trajectory. Real-time safe. Exception: a trajectory that another builder built
  /// before. @returns false, without changes, if it is null or no start time is set.
  virtual bool buildTrajectory(Trajectory* trajectory) = 0;

 protected:
  /// Empty unless set.
  const boost::optional<Time>& getStartTime() const { return start_time_; }
  /// The goal handle as it is now if one was set, else the default one.
  RealtimeGoalHandlePtr createGoalHandlePtr() const {
    return goal_handle_ ? *goal_handle_ : createDefaultGoalHandle();
  }
  /// A null pointer: no goal.
  static RealtimeGoalHandlePtr createDefaultGoalHandle() { return RealtimeGoalHandlePtr(); }

 private:
  boost::optional<Time> start_time_;
  const RealtimeGoalHandlePtr* goal_handle_{nullptr};
};

}  // namespace joint_trajectory_controller
