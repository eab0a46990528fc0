// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_trajectory_controller/trajectory_builder.h>

namespace joint_trajectory_controller {

/// Brings joints to rest within a given time: one segment per joint, ending where a motion that
/// reverses its velocity symmetrically has velocity zero.
template <class SegmentImpl>
class StopTrajectoryBuilder : public TrajectoryBuilder<SegmentImpl> {
 public:
  typedef typename TrajectoryBuilder<SegmentImpl>::Segment Segment;
  typedef typename TrajectoryBuilder<SegmentImpl>::Trajectory Trajectory;
  typedef typename TrajectoryBuilder<SegmentImpl>::Time Time;
  typedef typename TrajectoryBuilder<SegmentImpl>::RealtimeGoalHandlePtr RealtimeGoalHandlePtr;
  typedef typename Segment::State State;  ///< of a joint

  /// @param stop_trajectory_duration until rest [s], above 0
  /// @param desired_state start state, with a position and a velocity for each joint; it must
  /// outlive the builder.
  StopTrajectoryBuilder(Time stop_trajectory_duration, const State& desired_state)
      : duration_(stop_trajectory_duration),
        desired_state_(desired_state),
        from_(1),
        mirrored_(1),
        to_(1) {
    from_.acceleration.clear();
    mirrored_.acceleration.clear();
    // A sample at this point avoids later allocations.
    turn_.init(Time(0), from_, Time(1), mirrored_);
    turn_.sample(Time(0), to_);
  }

  bool buildTrajectory(Trajectory* trajectory) override {
    if (trajectory == nullptr || !this->getStartTime()) {
      return false;
    }
    const Time start = *this->getStartTime();
    const RealtimeGoalHandlePtr goal_handle = this->createGoalHandlePtr();
    trajectory->resize(desired_state_.position.size());
    for (std::size_t i = 0; i < trajectory->size(); ++i) {
      from_.position[0] = desired_state_.position[i];
      from_.velocity[0] = desired_state_.velocity[i];
      mirrored_.position[0] = from_.position[0];
      mirrored_.velocity[0] = -from_.velocity[0];
      turn_.init(start, from_, start + 2 * duration_, mirrored_);
      turn_.sample(start + duration_, to_);
      (*trajectory)[i].resize(1);
      Segment& segment = (*trajectory)[i][0];
      segment.init(start, from_, start + duration_, to_);
      segment.setGoalHandle(goal_handle);
    }
    return true;
  }

 private:
  const Time duration_;
  const State& desired_state_;
  State from_;
  State mirrored_;
  State to_;
  SegmentImpl turn_;
};

}  // namespace joint_trajectory_controller
