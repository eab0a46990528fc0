// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/switch_request.h>

#include <algorithm>

namespace controller_manager {
namespace internal {

using SwitchState = hardware_interface::RobotHW::SwitchState;

bool SwitchRequest::involves(const std::string& name) const {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const Start& start) { return start.info.name == name; }) ||
         std::any_of(stops.begin(), stops.end(),
                     [&](const Stop& stop) { return stop.name == name; });
}

bool SwitchRequest::advance(hardware_interface::RobotHW& robot, const ros::Time& time) {
  if (!begin(robot, time)) {
    return false;
  }
  if (cancelled.load(std::memory_order_relaxed)) {
    giveUp(time);
    return true;
  }
  return start_asap ? startEach(robot, time) : startTogether(robot, time);
}

bool SwitchRequest::begin(hardware_interface::RobotHW& robot, const ros::Time& time) {
  Phase expected = Phase::kPosted;
  if (!phase.compare_exchange_strong(expected, Phase::kTaken)) {
    return expected == Phase::kTaken;
  }
  begin_ = time;
  robot.doSwitch(start_list, stop_list);
  // In the first cycle only: later ones would stop restarted controllers again.
  for (const Stop& stop : stops) {
    if (stop.controller->isRunning()) {
      stop.controller->stopRequest(time);
    }
  }
  return true;
}

SwitchRequest::Outcome SwitchRequest::reasonToGiveUp(SwitchState state,
                                                     const ros::Time& time) const {
  if (state == SwitchState::ERROR) {
    return Outcome::kRobotError;
  }
  // As seconds, because ros::Time throws on differences out of range.
  return timeout > 0.0 && time.toSec() - begin_.toSec() > timeout ? Outcome::kTimeout
                                                                  : Outcome::kPending;
}

void SwitchRequest::giveUp(const ros::Time& time) {
  for (Start& start : starts) {
    if (start.outcome == Outcome::kPending) {
      start.controller->abortRequest(time);
      start.outcome = Outcome::kCancelled;
    }
  }
}

// The robot is asked once whether it is done and a second time whether it failed. Robots written
// for the original count on that, as do their tests.
bool SwitchRequest::startTogether(hardware_interface::RobotHW& robot, const ros::Time& time) {
  if (robot.switchResult() == SwitchState::DONE) {
    for (Start& start : starts) {
      start.controller->startRequest(time);
      start.outcome = Outcome::kStarted;
    }
    return true;
  }
  const Outcome reason = reasonToGiveUp(robot.switchResult(), time);
  for (Start& start : starts) {
    if (reason == Outcome::kPending) {
      start.controller->waitRequest(time);
    } else {
      start.controller->abortRequest(time);
      start.outcome = reason;
    }
  }
  return reason != Outcome::kPending;
}

bool SwitchRequest::startEach(hardware_interface::RobotHW& robot, const ros::Time& time) {
  bool settled = true;
  for (Start& start : starts) {
    if (start.outcome != Outcome::kPending) {
      continue;
    }
    if (robot.switchResult(start.info) == SwitchState::DONE) {
      start.controller->startRequest(time);
      start.outcome = Outcome::kStarted;
      continue;
    }
    start.outcome = reasonToGiveUp(robot.switchResult(start.info), time);
    if (start.outcome == Outcome::kPending) {
      start.controller->waitRequest(time);
      settled = false;
    } else {
      start.controller->abortRequest(time);
    }
  }
  return settled;
}

}  // namespace internal
}  // namespace controller_manager
