// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <string>

namespace franka_hw {

/// Says in the log what a controller threw; the same again only every few seconds, for it may
/// throw in every cycle. One thread; not for real time.
class ThrownReport {
 public:
  /// @param where whose controller it is, a name of a node or a robot
  /// @param advice what became of the robot, and what to do; a sentence
  void report(const std::string& where, const std::string& what, const std::string& advice) {
    const ros::WallTime now = ros::WallTime::now();
    if (what == last_ && now - said_ < ros::WallDuration(kPeriod)) {
      return;
    }
    last_ = what;
    said_ = now;
    ROS_ERROR_STREAM(where << ": a controller threw an exception: " << what << " " << advice);
  }

 private:
  static constexpr double kPeriod = 5.0;  // [s]

  std::string last_;
  ros::WallTime said_;
};

}  // namespace franka_hw
