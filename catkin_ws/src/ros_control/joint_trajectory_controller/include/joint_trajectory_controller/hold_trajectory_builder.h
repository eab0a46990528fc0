// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <joint_trajectory_controller/trajectory_builder.h>

#include <algorithm>
#include <vector>

namespace joint_trajectory_controller {
namespace internal {

/// Sets a segment of zero length, at rest. @param[in,out] state with one position, velocity and
/// acceleration; gets the position. Real-time safe. Exception: a segment that had another size
/// before.
template <class Segment>
void setHold(const typename Segment::Time& time, const typename Segment::Scalar& position,
             typename Segment::State& state, Segment& segment) {
  state.position[0] = position;
  segment.init(time, state, time, state);
}

}  // namespace internal

/// Holds the joints' positions at the time of building: one segment per joint, of zero length and
/// at rest.
/// @tparam HardwareInterface of the joints, whose handles have getPosition()
template <class SegmentImpl, class HardwareInterface>
class HoldTrajectoryBuilder : public TrajectoryBuilder<SegmentImpl> {
 public:
  typedef typename TrajectoryBuilder<SegmentImpl>::Segment Segment;
  typedef typename TrajectoryBuilder<SegmentImpl>::Trajectory Trajectory;
  typedef typename TrajectoryBuilder<SegmentImpl>::RealtimeGoalHandlePtr RealtimeGoalHandlePtr;
  typedef typename HardwareInterface::ResourceHandleType JointHandle;  ///< of the interface

  /// @param joints must outlive the builder.
  HoldTrajectoryBuilder(const std::vector<JointHandle>& joints) : joints_(joints), state_(1) {}

  /// As for TrajectoryBuilder; in a thread that may read the joints. @returns false, without
  /// changes, also if the trajectory does not have each joint with a segment: it must be allocated
  /// before, outside of the real-time loop.
  bool buildTrajectory(Trajectory* trajectory) override {
    if (trajectory == nullptr || !this->getStartTime() || trajectory->size() != joints_.size() ||
        std::any_of(trajectory->begin(), trajectory->end(),
                    [](const auto& joint) { return joint.empty(); })) {
      return false;
    }
    const RealtimeGoalHandlePtr goal_handle = this->createGoalHandlePtr();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      (*trajectory)[i].resize(1);
      Segment& segment = (*trajectory)[i][0];
      internal::setHold(*this->getStartTime(), joints_[i].getPosition(), state_, segment);
      segment.setGoalHandle(goal_handle);
    }
    return true;
  }

 private:
  const std::vector<JointHandle>& joints_;
  typename Segment::State state_;
};

}  // namespace joint_trajectory_controller
