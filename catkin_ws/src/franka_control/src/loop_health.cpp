// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "loop_health.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <sstream>

namespace franka_control {

namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr std::int64_t kMillisecond = 1000000;  // [ns]
// Below this share of commands received the robot is near an abort (20 lost in a row). [1]
constexpr double kPoorSuccessRate = 0.95;

std::string modeName(franka::RobotMode mode) {
  switch (mode) {
    case franka::RobotMode::kIdle:
      return "Idle";
    case franka::RobotMode::kMove:
      return "Move";
    case franka::RobotMode::kGuiding:
      return "Guiding";
    case franka::RobotMode::kReflex:
      return "Reflex";
    case franka::RobotMode::kUserStopped:
      return "User stopped";
    case franka::RobotMode::kAutomaticErrorRecovery:
      return "Automatic error recovery";
    case franka::RobotMode::kOther:
      break;
  }
  return "Other";
}

}  // namespace

LoopHealth::LoopHealth(const ros::NodeHandle& nh, const std::string& hardware_id)
    : updater_(nh, ros::NodeHandle(nh)) {
  updater_.setHardwareID(hardware_id);
  updater_.add("Robot", this, &LoopHealth::describeRobot);
  updater_.add("Control loop", this, &LoopHealth::describeLoop);
  timer_ = ros::NodeHandle(nh).createWallTimer(ros::WallDuration(1.0),
                                               [this](const auto&) { updater_.force_update(); });
}

void LoopHealth::cycleEnds() noexcept {
  const std::int64_t elapsed = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                   std::chrono::steady_clock::now() - begin_)
                                   .count();
  cycles_.fetch_add(1, std::memory_order_relaxed);
  total_.fetch_add(elapsed, std::memory_order_relaxed);
  if (elapsed > longest_.load(std::memory_order_relaxed)) {
    longest_.store(elapsed, std::memory_order_relaxed);
  }
  if (elapsed > kMillisecond) {
    overruns_.fetch_add(1, std::memory_order_relaxed);
  }
}

void LoopHealth::describeRobot(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!connected_) {
    status.summary(DiagnosticStatus::ERROR, "Not connected to the robot");
    return;
  }
  const franka::RobotState& state = states_.read();
  const bool moving = state.robot_mode == franka::RobotMode::kMove;
  const std::string errors = static_cast<std::string>(state.current_errors);
  if (has_error_ || state.current_errors) {
    status.summary(DiagnosticStatus::ERROR, "In error; call the action error_recovery");
  } else if (state.robot_mode != franka::RobotMode::kIdle && !moving) {
    status.summary(DiagnosticStatus::WARN, "The robot takes no commands in this mode");
  } else if (moving && state.control_command_success_rate < kPoorSuccessRate) {
    status.summary(DiagnosticStatus::WARN, "Many commands reach the robot too late");
  } else {
    status.summary(DiagnosticStatus::OK, "Ready");
  }
  status.add("Mode", modeName(state.robot_mode));
  status.add("Current errors", errors);
  status.add("Errors of the last motion", static_cast<std::string>(state.last_motion_errors));
  status.add("control_command_success_rate", state.control_command_success_rate);
  status.add("Robot time [s]", state.time.toSec());
}

void LoopHealth::describeLoop(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::uint64_t cycles = cycles_.exchange(0, std::memory_order_relaxed);
  const std::int64_t total = total_.exchange(0, std::memory_order_relaxed);
  const std::int64_t longest = longest_.exchange(0, std::memory_order_relaxed);
  if (cycles == 0) {
    status.summary(DiagnosticStatus::WARN, "The controllers were not updated");
  } else if (longest > kMillisecond) {
    status.summary(DiagnosticStatus::WARN, "The controllers took longer than a millisecond");
  } else {
    status.summary(DiagnosticStatus::OK, "The controllers keep time");
  }
  status.add("Cycles since the last report", cycles);
  status.add("Mean time of the controllers [ms]", cycles > 0 ? 1e-6 * total / cycles : 0.0);
  status.add("Longest time of the controllers [ms]", 1e-6 * longest);
  status.add("Cycles longer than a millisecond, since the start", overruns_.load());
}

}  // namespace franka_control
