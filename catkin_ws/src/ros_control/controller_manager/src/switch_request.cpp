// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/switch_request.h>

#include <algorithm>
#include <cstdio>
#include <exception>

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
  for (const Stop& stopped : stops) {
    if (stopped.controller->isRunning()) {
      stop(stopped, time);
    }
  }
  return true;
}

void SwitchRequest::start(Start& start, const ros::Time& time) const {
  start.outcome = Outcome::kStarted;
  if (!guarded) {
    start.controller->startRequest(time);
    return;
  }
  try {
    start.controller->startRequest(time);
  } catch (const std::exception& error) {
    std::snprintf(start.thrown.data(), start.thrown.size(), "%s", error.what());
    start.outcome = Outcome::kThrew;
  } catch (...) {
    std::snprintf(start.thrown.data(), start.thrown.size(), "an exception of unknown type");
    start.outcome = Outcome::kThrew;
  }
  if (start.outcome == Outcome::kThrew) {
    start.controller->state_ = controller_interface::ControllerBase::ControllerState::ABORTED;
  }
}

void SwitchRequest::stop(const Stop& stop, const ros::Time& time) const {
  if (!guarded) {
    stop.controller->stopRequest(time);
    return;
  }
  try {
    stop.controller->stopRequest(time);
  } catch (...) {
    stop.controller->state_ = controller_interface::ControllerBase::ControllerState::ABORTED;
  }
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
    for (Start& started : starts) {
      start(started, time);
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
  for (Start& waiting : starts) {
    if (waiting.outcome != Outcome::kPending) {
      continue;
    }
    if (robot.switchResult(waiting.info) == SwitchState::DONE) {
      start(waiting, time);
      continue;
    }
    waiting.outcome = reasonToGiveUp(robot.switchResult(waiting.info), time);
    if (waiting.outcome == Outcome::kPending) {
      waiting.controller->waitRequest(time);
      settled = false;
    } else {
      waiting.controller->abortRequest(time);
    }
  }
  return settled;
}

}  // namespace internal
}  // namespace controller_manager
