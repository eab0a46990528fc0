// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>

#include <functional>
#include <string>

namespace franka_hw {

/// Connects again, once a second, to a robot that was lost, if the parameter `reconnect` is true
/// (bool, default false; searched for from the namespace of the robot upwards).
///
/// Called by the thread that reads the robot. Not real-time safe.
class Reconnection {
 public:
  /// Reads the parameter. @returns false, after logging the reason, if it is neither true nor false
  bool init(const ros::NodeHandle& nh);

  /// Calls `connect` if the parameter is true and the next attempt is due. Exceptions are logged as
  /// warnings, at most twice a minute.
  /// @param robot its name, for the warning
  void attempt(const std::string& robot, const std::function<void()>& connect);

  /// A message: the robot is lost, why, and what follows. @param what the text of libfranka
  std::string report(const std::string& what) const;

 private:
  bool enabled_{false};
  ros::WallTime last_attempt_, last_warning_;
};

}  // namespace franka_hw
