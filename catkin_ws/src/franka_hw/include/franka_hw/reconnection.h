// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>

#include <functional>
#include <string>

namespace franka_hw {

/// Connects again, once a second, to a robot that was lost, if the parameter `reconnect` says so
/// (bool, false unless given; searched for from the namespace of the robot upwards).
///
/// For the thread that watches the robot; not real-time safe.
class Reconnection {
 public:
  /// Reads the parameter. @returns false after a sentence when it is neither true nor false
  bool init(const ros::NodeHandle& nh);

  /// Calls `connect` if it is wanted and time for it. Of what it throws a warning tells, twice a
  /// minute at most.
  /// @param robot its name, for the warning
  void attempt(const std::string& robot, const std::function<void()>& connect);

  /// That the robot is lost, why, and what comes next. @param what libfranka says of it
  std::string report(const std::string& what) const;

 private:
  bool wanted_{false};
  ros::WallTime last_attempt_, last_warning_;
};

}  // namespace franka_hw
