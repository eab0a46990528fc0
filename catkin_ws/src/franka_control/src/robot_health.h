// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_hw/arm_connection.h>
#include <franka_hw/response_times.h>
#include <realtime_tools/latest_value.h>
#include <ros/node_handle.h>

#include <string>

#include "status.h"

namespace franka_control {

/// The status of a robot on /diagnostics: its mode and errors, the share of commands that reached
/// it, the response times, and how evenly its states arrived.
///
/// The thread of the loop calls `state`. Real-time safe.
class RobotHealth {
 public:
  /// @param name of the status @param arm_id names the robot @param connection to it
  /// @param response_times of the robot; only this object takes reports
  RobotHealth(const ros::NodeHandle& nh, const std::string& name, const std::string& arm_id,
              const franka_hw::ArmConnection& connection, franka_hw::ResponseTimes& response_times);

  void state(const franka::RobotState& robot_state) noexcept { states_.write(robot_state); }

 private:
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

  realtime_tools::LatestValue<franka::RobotState> states_;
  const franka_hw::ArmConnection& connection_;
  franka_hw::ResponseTimes& response_times_;
  Status status_;
};

}  // namespace franka_control
