// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/robot/mode_machine.h>

namespace franka_sim_mujoco {

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
    {RobotMode::kIdle, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kMove, ModeEvent::kUserStopPressed, RobotMode::kUserStopped},
    {RobotMode::kUserStopped, ModeEvent::kUserStopReleased, RobotMode::kIdle},
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

bool ModeMachine::brakesClosed() const noexcept {
  return mode_ == RobotMode::kUserStopped || mode_ == RobotMode::kOther;
}

}  // namespace franka_sim_mujoco
