// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/console.h>
#include <ros/node_handle.h>

#include <string>

namespace franka_control {

/// Reads a boolean parameter; does not change `flag` if the parameter is not set. @returns false,
/// after logging the reason, if it is not a boolean
inline bool readFlag(const std::string& name, const ros::NodeHandle& nh, bool& flag) {
  if (!nh.hasParam(name) || nh.getParam(name, flag)) {
    return true;
  }
  ROS_ERROR_STREAM("franka_control: the parameter '" << nh.resolveName(name)
                                                     << "' is not true or false.");
  return false;
}

}  // namespace franka_control
