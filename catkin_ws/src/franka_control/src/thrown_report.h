// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <string>

namespace franka_control {

/// Says in the log what a controller threw; the same again only every few seconds, for it may
/// throw in every cycle. One thread.
class ThrownReport {
 public:
  void report(const std::string& what) {
    const ros::WallTime now = ros::WallTime::now();
    if (what == last_ && now - said_ < ros::WallDuration(kPeriod)) {
      return;
    }
    last_ = what;
    said_ = now;
    ROS_ERROR_STREAM("franka_control: a controller threw an exception: "
                     << what
                     << " The robot is not moved until the controller has been stopped "
                        "(controller_manager/switch_controller) and error_recovery called.");
  }

 private:
  static constexpr double kPeriod = 5.0;  // [s]

  std::string last_;
  ros::WallTime said_;
};

}  // namespace franka_control
