// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>

namespace trajectory_interface {

/// The last segment that starts at or before a time; `last` if all start later. Segments are sorted
/// by start. Real-time safe.
template <class TrajectoryIterator, class Time>
TrajectoryIterator findSegment(TrajectoryIterator first, TrajectoryIterator last,
                               const Time& time) {
  typedef typename std::iterator_traits<TrajectoryIterator>::value_type Segment;
  const TrajectoryIterator later = std::upper_bound(
      first, last, time,
      [](const Time& at, const Segment& segment) { return at < segment.startTime(); });
  return later == first ? last : std::prev(later);
}

template <class Trajectory, class Time>
typename Trajectory::const_iterator findSegment(const Trajectory& trajectory, const Time& time) {
  return findSegment(trajectory.begin(), trajectory.end(), time);
}

template <class Trajectory, class Time>
typename Trajectory::iterator findSegment(Trajectory& trajectory, const Time& time) {
  return findSegment(trajectory.begin(), trajectory.end(), time);
}

/// The state of a trajectory at a time. Real-time safe.
/// @param[out] state sized for the segment; before the trajectory its first state, at rest;
/// unchanged for an empty trajectory.
/// @return the sampled segment, or the end if the trajectory starts later or is empty.
template <class Trajectory>
typename Trajectory::const_iterator sample(const Trajectory& trajectory,
                                           const typename Trajectory::value_type::Time& time,
                                           typename Trajectory::value_type::State& state) {
  const auto segment = findSegment(trajectory, time);
  if (segment != trajectory.end()) {
    segment->sample(time, state);
  } else if (!trajectory.empty()) {
    trajectory.front().sample(time, state);
  }
  return segment;
}

}  // namespace trajectory_interface
