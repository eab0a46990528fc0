// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_trajectory_controller/joint_trajectory_segment.h>

#include <vector>

namespace joint_trajectory_controller {

/// Builds trajectories of one kind, starting at a time that is set.
template <class SegmentImpl>
class TrajectoryBuilder {
 public:
  typedef JointTrajectorySegment<SegmentImpl> Segment;
  typedef std::vector<Segment> TrajectoryPerJoint;
  typedef std::vector<TrajectoryPerJoint> Trajectory;
  typedef typename Segment::Time Time;
  typedef typename Segment::RealtimeGoalHandlePtr RealtimeGoalHandlePtr;

  virtual ~TrajectoryBuilder() = default;

  /// @param start_time of the next trajectory, in the trajectories' time base [s]
  TrajectoryBuilder* setStartTime(const Time& start_time) {
    start_time_ = start_time;
    return this;
  }
  /// @param goal_handle of the next trajectory's segments; null for none
  TrajectoryBuilder* setGoalHandle(const RealtimeGoalHandlePtr& goal_handle) {
    goal_handle_ = goal_handle;
    return this;
  }
  virtual void reset() {
    start_time_ = Time(0);
    goal_handle_.reset();
  }

  /// Overwrites a trajectory. Real-time safe when it was built by the same builder before.
  virtual bool buildTrajectory(Trajectory* trajectory) = 0;

 protected:
  Time start_time_{0};
  RealtimeGoalHandlePtr goal_handle_;
};

}  // namespace joint_trajectory_controller
