// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <functional>
#include <string>

namespace franka_control {

/// One status on /diagnostics, published once a second.
class Status {
 public:
  using Describe = std::function<void(diagnostic_updater::DiagnosticStatusWrapper&)>;

  /// @param name of the status, after the node's name @param hardware_id names the robot
  /// @param describe fills the status, in a thread of the node handle; outlives this object
  Status(const ros::NodeHandle& nh, const std::string& name, const std::string& hardware_id,
         const Describe& describe)
      : updater_(nh, ros::NodeHandle(nh)) {
    updater_.setHardwareID(hardware_id);
    updater_.add(name, describe);
    timer_ = ros::NodeHandle(nh).createWallTimer(ros::WallDuration(1.0),
                                                 [this](const auto&) { updater_.force_update(); });
  }

 private:
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace franka_control
