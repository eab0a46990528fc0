// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "reconnection.h"

#include <ros/console.h>

#include <exception>

namespace franka_hw {

namespace {

const ros::WallDuration kAttemptPeriod(1.0);   // [s]
const ros::WallDuration kWarningPeriod(30.0);  // [s]

}  // namespace

bool Reconnection::init(const ros::NodeHandle& nh) {
  std::string name;
  if (!nh.searchParam("reconnect", name) || nh.getParam(name, enabled_)) {
    return true;
  }
  ROS_ERROR_STREAM("FrankaHW: the parameter '" << name << "' is not true or false.");
  return false;
}

void Reconnection::attempt(const std::string& robot, const std::function<void()>& connect) {
  const ros::WallTime now = ros::WallTime::now();
  if (!enabled_ || now - last_attempt_ < kAttemptPeriod) {
    return;
  }
  try {
    connect();
  } catch (const std::exception& error) {
    if (now - last_warning_ > kWarningPeriod) {
      last_warning_ = now;
      ROS_WARN_STREAM("FrankaHW: still no connection to '" << robot << "'. " << error.what());
    }
  }
  last_attempt_ = ros::WallTime::now();
}

std::string Reconnection::report(const std::string& what) const {
  const bool silent = what.find("Timeout") != std::string::npos;
  return "the robot is lost. " + what +
         (silent ? " It has sent no states for a second or more: it is switched off, the network "
                   "path is broken, or, if it is a simulated one, its computer had no time for it."
                 : "") +
         (enabled_ ? " Trying to connect again every second."
                   : " Call the service connect when it is back.");
}

}  // namespace franka_hw
