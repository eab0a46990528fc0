// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot_health.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <iomanip>
#include <sstream>
#include <string>

namespace franka_control {

namespace {

using diagnostic_msgs::DiagnosticStatus;

// Below this share of received commands the robot is near an abort (20 lost in a row). [1]
constexpr double kPoorSuccessRate = 0.95;

std::string modeName(franka::RobotMode mode) {
  std::stringstream text;
  std::string name;
  text << mode;
  text >> std::quoted(name);
  return name;
}

}  // namespace

RobotHealth::RobotHealth(const ros::NodeHandle& nh, const std::string& name,
                         const std::string& arm_id, const franka_hw::ArmConnection& connection,
                         franka_hw::ResponseTimes& response_times)
    : connection_(connection),
      response_times_(response_times),
      status_(nh, name, arm_id, [this](auto& status) { describe(status); }) {}

void RobotHealth::describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!connection_.connected()) {
    status.summary(DiagnosticStatus::ERROR, "Not connected to the robot");
    return;
  }
  const franka::RobotState& state = states_.read();
  const bool moving = state.robot_mode == franka::RobotMode::kMove;
  const std::string errors = static_cast<std::string>(state.current_errors);
  if (connection_.hasOwnError() || state.current_errors) {
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
  const franka_hw::ResponseTimes::Report times = response_times_.take();
  status.add("Commands since the last report", times.cycles);
  status.add("From a state to its command, mean [ms]", 1e3 * times.mean);
  status.add("From a state to its command, longest [ms]", 1e3 * times.longest);
  status.add("Latest state behind the promptest [ms]", 1e3 * times.spread);
}

}  // namespace franka_control
