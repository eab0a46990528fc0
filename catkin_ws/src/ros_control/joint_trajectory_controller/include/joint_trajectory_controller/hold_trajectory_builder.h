// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_trajectory_controller/trajectory_builder.h>

namespace joint_trajectory_controller {

/// Holds the position of a state: one segment a joint, without length and at rest.
template <class SegmentImpl>
class HoldTrajectoryBuilder : public TrajectoryBuilder<SegmentImpl> {
 public:
  typedef typename TrajectoryBuilder<SegmentImpl>::Segment Segment;
  typedef typename TrajectoryBuilder<SegmentImpl>::Trajectory Trajectory;
  typedef typename Segment::State State;

  /// @param state with one position a joint; it must outlive the builder.
  explicit HoldTrajectoryBuilder(const State& state) : state_(state), joint_state_(1) {}

  bool buildTrajectory(Trajectory* trajectory) override {
    trajectory->resize(state_.position.size());
    for (std::size_t i = 0; i < trajectory->size(); ++i) {
      joint_state_.position[0] = state_.position[i];
      (*trajectory)[i].resize(1);
      Segment& segment = (*trajectory)[i][0];
      segment.init(this->start_time_, joint_state_, this->start_time_, joint_state_);
      segment.setGoalHandle(this->goal_handle_);
    }
    return true;
  }

 private:
  const State& state_;
  State joint_state_;
};

}  // namespace joint_trajectory_controller
