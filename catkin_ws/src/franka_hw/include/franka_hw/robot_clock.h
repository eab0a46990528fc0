// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>
#include <ros/duration.h>
#include <ros/time.h>

namespace franka_hw {

/// The time of controllers: the robot's own milliseconds, set to the clock of ROS (decision 23).
///
/// The time of a cycle is not when the thread happened to wake up, but when the robot measured:
/// between two cycles passes what passed on the robot. It follows the clock of ROS by at most 1 %
/// of the time that passes, so that the jitter of the network does not show and the time never goes
/// back. After a gap of more than half a second, or when the robot counts anew, it is set to the
/// clock of ROS again, still never going back. One thread; real-time safe.
class RobotClock {
 public:
  /// @param robot_time of a state @param now on the clock of ROS, when the state arrived
  /// @returns the time of that state
  ros::Time update(franka::Duration robot_time, const ros::Time& now) noexcept;

  /// The latest time told.
  const ros::Time& time() const noexcept { return time_; }

 private:
  bool started_{false};
  double robot_seconds_{0.0};
  ros::Time time_;
};

}  // namespace franka_hw
