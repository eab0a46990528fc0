// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>
#include <ros/duration.h>
#include <ros/time.h>

namespace franka_hw {

/// The time for controllers: the robot's milliseconds, converted to the clock of ROS (decision 23).
///
/// The time of a cycle is the time at which the robot measured, not the time at which the thread
/// woke up: the time between two cycles is the time that passed on the robot. It is adjusted to the
/// clock of ROS by at most 1 % of the elapsed time, so that it contains no jitter of the network
/// and never goes back. After a gap of more than half a second, or when the robot's time restarts,
/// it is set to the clock of ROS again and still never goes back. Called by one thread.
/// Real-time safe.
class RobotClock {
 public:
  /// @param robot_time of a state @param now on the clock of ROS, when the state arrived
  /// @returns the time of that state
  ros::Time update(franka::Duration robot_time, const ros::Time& now) noexcept;

  /// The time that update() returned last.
  const ros::Time& time() const noexcept { return time_; }

 private:
  bool started_{false};
  double robot_seconds_{0.0};
  ros::Time time_;
};

}  // namespace franka_hw
