// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <franka/robot_state.h>
#include <franka_hw/latest.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace franka_control {

/// What is told on /diagnostics, once a second: mode and errors of the robot, share of commands
/// that reached it, and how long the controllers take.
///
/// The loop calls `state`, `cycleBegins` and `cycleEnds`, which neither lock nor allocate.
class LoopHealth {
 public:
  /// @param hardware_id names the robot in the diagnostics
  LoopHealth(const ros::NodeHandle& nh, const std::string& hardware_id);

  void state(const franka::RobotState& robot_state) noexcept { states_.write(robot_state); }
  void connected(bool connected) noexcept { connected_ = connected; }
  void hasError(bool has_error) noexcept { has_error_ = has_error; }

  void cycleBegins() noexcept { begin_ = std::chrono::steady_clock::now(); }
  void cycleEnds() noexcept;

 private:
  void describeRobot(diagnostic_updater::DiagnosticStatusWrapper& status);
  void describeLoop(diagnostic_updater::DiagnosticStatusWrapper& status);

  franka_hw::Latest<franka::RobotState> states_;
  std::atomic_bool connected_{false};
  std::atomic_bool has_error_{false};

  std::chrono::steady_clock::time_point begin_{};
  std::atomic<std::uint64_t> cycles_{0};    // of controllers, since the last report
  std::atomic<std::int64_t> total_{0};      // [ns] that they took
  std::atomic<std::int64_t> longest_{0};    // [ns]
  std::atomic<std::uint64_t> overruns_{0};  // cycles longer than a millisecond, ever

  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace franka_control
