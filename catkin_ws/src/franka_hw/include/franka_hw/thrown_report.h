// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <string>

namespace franka_hw {

/// Logs the exceptions of a controller. The same text is logged only every few seconds, because a
/// controller may throw in every cycle. Called by one thread. Not real-time safe.
class ThrownReport {
 public:
  /// @param where the name of the node or robot that runs the controller
  /// @param advice the consequence for the robot, and the next step for the user; a sentence
  void report(const std::string& where, const std::string& what, const std::string& advice) {
    const ros::WallTime now = ros::WallTime::now();
    if (what == last_ && now - last_report_time_ < ros::WallDuration(kPeriod)) {
      return;
    }
    last_ = what;
    last_report_time_ = now;
    ROS_ERROR_STREAM(where << ": a controller threw an exception: " << what << " " << advice);
  }

 private:
  static constexpr double kPeriod = 5.0;  // [s]

  std::string last_;
  ros::WallTime last_report_time_;
};

}  // namespace franka_hw
