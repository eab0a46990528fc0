// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_hw/latest.h>
#include <franka_hw/response_times.h>
#include <ros/node_handle.h>

#include <atomic>
#include <string>

#include "status.h"

namespace franka_control {

/// What is told of a robot on /diagnostics: its mode and errors, the share of commands that reached
/// it, how fast they left, and how evenly its states arrived.
///
/// The loop calls `state`, which neither locks nor allocates.
class RobotHealth {
 public:
  /// @param name of the status @param arm_id names the robot
  /// @param response_times of the robot; reports are taken here alone
  RobotHealth(const ros::NodeHandle& nh, const std::string& name, const std::string& arm_id,
              franka_hw::ResponseTimes& response_times);

  void state(const franka::RobotState& robot_state) noexcept { states_.write(robot_state); }
  void connected(bool connected) noexcept { connected_ = connected; }
  void hasError(bool has_error) noexcept { has_error_ = has_error; }

 private:
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

  franka_hw::Latest<franka::RobotState> states_;
  franka_hw::ResponseTimes& response_times_;
  std::atomic_bool connected_{false};
  std::atomic_bool has_error_{false};
  Status status_;
};

}  // namespace franka_control
