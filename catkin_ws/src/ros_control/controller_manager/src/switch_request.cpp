// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/switch_request.h>

#include <algorithm>
#include <exception>

namespace controller_manager {
namespace internal {

using State = controller_interface::ControllerBase::ControllerState;
using SwitchState = hardware_interface::RobotHW::SwitchState;

bool SwitchRequest::involves(const std::string& name) const {
  return std::any_of(starts.begin(), starts.end(),
                     [&](const Start& start) { return start.info.name == name; }) ||
         std::any_of(stops.begin(), stops.end(),
                     [&](const Stop& stop) { return stop.name == name; });
}

bool SwitchRequest::advance(hardware_interface::RobotHW& robot, const ros::Time& time) {
  try {
    return proceed(robot, time);
  } catch (const std::exception& error) {
    copyText(error.what(), broken_by);
    abandon();
    throw;
  } catch (...) {
    copyText("an exception of unknown type", broken_by);
    abandon();
    throw;
  }
}

bool SwitchRequest::proceed(hardware_interface::RobotHW& robot, const ros::Time& time) {
  if (!begin(robot, time)) {
    return false;
  }
  if (canceled.load(std::memory_order_relaxed)) {
    for (Start& start : starts) {
      if (start.outcome == Outcome::kPending) {
        giveUp(start, Outcome::kCanceled, time);
      }
    }
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
  // Only in the first cycle: later ones would stop restarted controllers again.
  for (const Stop& stopped : stops) {
    if (stopped.controller->isRunning()) {
      stop(stopped, time);
    }
  }
  begun_ = true;
  return true;
}

void SwitchRequest::abandon() {
  broken = true;
  for (const Start& start : starts) {
    if (start.outcome == Outcome::kPending) {
      start.controller->state_ = State::ABORTED;
    }
  }
  for (const Stop& stop : stops) {
    if (!begun_ && stop.controller->isRunning()) {
      stop.controller->state_ = State::ABORTED;
    }
  }
}

template <class Call>
bool SwitchRequest::runs(Start& start, const char* callback, Call call) const {
  if (!guarded) {
    call();
    return true;
  }
  if (runsThrough(call, start.thrown)) {
    return true;
  }
  start.thrower = callback;
  start.controller->state_ = State::ABORTED;
  return false;
}

void SwitchRequest::start(Start& start, const ros::Time& time) const {
  const bool started = runs(start, "starting", [&] { start.controller->startRequest(time); });
  start.outcome = started ? Outcome::kStarted : Outcome::kThrew;
}

void SwitchRequest::wait(Start& start, const ros::Time& time) const {
  if (!runs(start, "waiting", [&] { start.controller->waitRequest(time); })) {
    start.outcome = Outcome::kThrew;
  }
}

void SwitchRequest::giveUp(Start& start, Outcome reason, const ros::Time& time) const {
  runs(start, "aborting", [&] { start.controller->abortRequest(time); });
  start.outcome = reason;
}

void SwitchRequest::stop(const Stop& stop, const ros::Time& time) const {
  const auto request = [&] { stop.controller->stopRequest(time); };
  ExceptionText thrown;
  if (!guarded) {
    request();
  } else if (!runsThrough(request, thrown)) {
    stop.controller->state_ = State::ABORTED;
  }
}

SwitchRequest::Outcome SwitchRequest::reasonToGiveUp(SwitchState state,
                                                     const ros::Time& time) const {
  if (state == SwitchState::ERROR) {
    return Outcome::kRobotError;
  }
  // In seconds, because ros::Time throws on differences out of range.
  return timeout > 0.0 && time.toSec() - begin_.toSec() > timeout ? Outcome::kTimeout
                                                                  : Outcome::kPending;
}

// switchResult is called once for done and a second time for failure. Robots written for the
// original rely on this, as do their tests.
bool SwitchRequest::startTogether(hardware_interface::RobotHW& robot, const ros::Time& time) {
  const bool ready = robot.switchResult() == SwitchState::DONE;
  const Outcome reason = ready ? Outcome::kPending : reasonToGiveUp(robot.switchResult(), time);
  for (Start& pending : starts) {
    if (pending.outcome != Outcome::kPending) {
      continue;
    }
    if (ready) {
      start(pending, time);
    } else if (reason == Outcome::kPending) {
      wait(pending, time);
    } else {
      giveUp(pending, reason, time);
    }
  }
  return ready || reason != Outcome::kPending;
}

bool SwitchRequest::startEach(hardware_interface::RobotHW& robot, const ros::Time& time) {
  bool settled = true;
  for (Start& pending : starts) {
    if (pending.outcome != Outcome::kPending) {
      continue;
    }
    if (robot.switchResult(pending.info) == SwitchState::DONE) {
      start(pending, time);
      continue;
    }
    const Outcome reason = reasonToGiveUp(robot.switchResult(pending.info), time);
    if (reason == Outcome::kPending) {
      wait(pending, time);
      settled = settled && pending.outcome != Outcome::kPending;
    } else {
      giveUp(pending, reason, time);
    }
  }
  return settled;
}

}  // namespace internal
}  // namespace controller_manager
