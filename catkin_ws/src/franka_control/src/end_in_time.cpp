// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "end_in_time.h"

#include <ros/console.h>
#include <ros/init.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace franka_control {

namespace {

// Time between two checks whether ROS shuts down.
constexpr std::chrono::milliseconds kPeriod{50};
constexpr double kMaxTimeout = 3600.0;  // [s], chosen here

}  // namespace

EndInTime::EndInTime(std::string node) : node_(std::move(node)), thread_(&EndInTime::watch, this) {}

EndInTime::~EndInTime() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

bool EndInTime::readTimeout(const ros::NodeHandle& nh) {
  double timeout = timeout_;
  if (nh.hasParam("shutdown_timeout") &&
      (!nh.getParam("shutdown_timeout", timeout) || !(timeout >= 0.0 && timeout <= kMaxTimeout))) {
    ROS_ERROR_STREAM("franka_control: the parameter '" << nh.resolveName("shutdown_timeout")
                                                       << "' is not a number from 0 to "
                                                       << kMaxTimeout << " s.");
    return false;
  }
  timeout_ = timeout;
  return true;
}

void EndInTime::watch() {
  // Not ros::ok(), which is also false before the first node handle.
  while (!ros::isShuttingDown()) {
    if (endedWithin(kPeriod)) {
      return;
    }
  }
  if (!endedWithin(std::chrono::duration<double>(timeout_))) {
    std::fprintf(stderr, "%s: ended without the robot's answer, which did not come in time.\n",
                 node_.c_str());
    std::_Exit(EXIT_FAILURE);
  }
}

bool EndInTime::endedWithin(std::chrono::duration<double> time) {
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.wait_for(lock, time, [this] { return ended_; });
}

}  // namespace franka_control
