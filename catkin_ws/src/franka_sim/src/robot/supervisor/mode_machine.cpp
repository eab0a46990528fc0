// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/supervisor/mode_machine.h"

namespace franka_sim {

using franka_core::RobotMode;

namespace {

struct Transition {
  RobotMode from;
  ModeEvent event;
  RobotMode to;
};

constexpr Transition kTransitions[] = {
    {RobotMode::kIdle, ModeEvent::kMotionStarted, RobotMode::kMove},
    {RobotMode::kMove, ModeEvent::kMotionEnded, RobotMode::kIdle},

    {RobotMode::kIdle, ModeEvent::kError, RobotMode::kReflex},
    {RobotMode::kMove, ModeEvent::kError, RobotMode::kReflex},
    {RobotMode::kReflex, ModeEvent::kRecoveryStarted, RobotMode::kAutomaticErrorRecovery},
    {RobotMode::kAutomaticErrorRecovery, ModeEvent::kRecoveryEnded, RobotMode::kIdle},
    {RobotMode::kAutomaticErrorRecovery, ModeEvent::kRecoveryFailed, RobotMode::kReflex},

    {RobotMode::kIdle, ModeEvent::kGuidingStarted, RobotMode::kGuiding},
    {RobotMode::kMove, ModeEvent::kGuidingStarted, RobotMode::kGuiding},
    // Guiding must be able to move the arm out of poses from which no recovery is possible.
    {RobotMode::kReflex, ModeEvent::kGuidingStarted, RobotMode::kGuiding},
    {RobotMode::kGuiding, ModeEvent::kGuidingEnded, RobotMode::kIdle},

    {RobotMode::kIdle, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kMove, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kGuiding, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kReflex, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kAutomaticErrorRecovery, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kUserStopped, ModeEvent::kUserStopReleased, RobotMode::kIdle},

    {RobotMode::kIdle, ModeEvent::kBrakesClosed, RobotMode::kOther},
    {RobotMode::kMove, ModeEvent::kBrakesClosed, RobotMode::kOther},
    {RobotMode::kGuiding, ModeEvent::kBrakesClosed, RobotMode::kOther},
    {RobotMode::kReflex, ModeEvent::kBrakesClosed, RobotMode::kOther},
    {RobotMode::kAutomaticErrorRecovery, ModeEvent::kBrakesClosed, RobotMode::kOther},
    {RobotMode::kUserStopped, ModeEvent::kBrakesClosed, RobotMode::kOther},
    {RobotMode::kOther, ModeEvent::kBrakesOpened, RobotMode::kIdle},
};

}  // namespace

bool ModeMachine::handle(ModeEvent event) noexcept {
  for (const Transition& transition : kTransitions) {
    if (transition.from == mode_ && transition.event == event) {
      mode_ = transition.to;
      return true;
    }
  }
  return false;
}

bool ModeMachine::closesBrakes() const noexcept {
  return mode_ == RobotMode::kUserStopped || mode_ == RobotMode::kOther;
}

}  // namespace franka_sim
