// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/arm_state.h>

namespace franka_hw {

namespace {

struct Transition {
  ArmState from;
  ArmEvent event;
  ArmState to;
};

constexpr Transition kTransitions[] = {
    {ArmState::kDisconnected, ArmEvent::kConnected, ArmState::kIdle},
    {ArmState::kLost, ArmEvent::kConnected, ArmState::kIdle},
    // Controllers that ran when the robot was lost must not move it before a recovery.
    {ArmState::kLostInError, ArmEvent::kConnected, ArmState::kError},

    {ArmState::kIdle, ArmEvent::kGivenUp, ArmState::kDisconnected},
    {ArmState::kStopped, ArmEvent::kGivenUp, ArmState::kDisconnected},
    {ArmState::kError, ArmEvent::kGivenUp, ArmState::kDisconnected},
    {ArmState::kLost, ArmEvent::kGivenUp, ArmState::kDisconnected},
    {ArmState::kLostInError, ArmEvent::kGivenUp, ArmState::kDisconnected},

    // A loss within a motion ends the motion first.
    {ArmState::kIdle, ArmEvent::kLost, ArmState::kLost},
    {ArmState::kStopped, ArmEvent::kLost, ArmState::kLostInError},
    {ArmState::kError, ArmEvent::kLost, ArmState::kLostInError},

    {ArmState::kIdle, ArmEvent::kMotionStarted, ArmState::kMoving},
    {ArmState::kMoving, ArmEvent::kMotionEnded, ArmState::kIdle},
    {ArmState::kBraking, ArmEvent::kMotionEnded, ArmState::kError},

    // Reported after the motion has ended.
    {ArmState::kIdle, ArmEvent::kRobotStopped, ArmState::kStopped},

    {ArmState::kIdle, ArmEvent::kFailed, ArmState::kError},
    {ArmState::kMoving, ArmEvent::kFailed, ArmState::kBraking},
    {ArmState::kStopped, ArmEvent::kFailed, ArmState::kError},
    {ArmState::kLost, ArmEvent::kFailed, ArmState::kLostInError},
    // A controller was started while the robot was given up.
    {ArmState::kDisconnected, ArmEvent::kFailed, ArmState::kLostInError},

    {ArmState::kStopped, ArmEvent::kRecovered, ArmState::kIdle},
    {ArmState::kError, ArmEvent::kRecovered, ArmState::kIdle},
    {ArmState::kStopped, ArmEvent::kRecoveredElsewhere, ArmState::kIdle},
};

/// @returns whether there is a transition, which is written to `state`
bool advance(ArmState& state, ArmEvent event) noexcept {
  for (const Transition& transition : kTransitions) {
    if (transition.from == state && transition.event == event) {
      state = transition.to;
      return true;
    }
  }
  return false;
}

}  // namespace

bool isConnected(ArmState state) noexcept {
  return state != ArmState::kDisconnected && !isLost(state);
}

bool isInMotion(ArmState state) noexcept {
  return state == ArmState::kMoving || state == ArmState::kBraking;
}

bool isInError(ArmState state) noexcept {
  return state == ArmState::kBraking || state == ArmState::kStopped || state == ArmState::kError ||
         state == ArmState::kLostInError;
}

bool isLost(ArmState state) noexcept {
  return state == ArmState::kLost || state == ArmState::kLostInError;
}

bool ArmStateMachine::handle(ArmEvent event) noexcept {
  ArmState before = state_;
  ArmState after = before;
  while (advance(after, event)) {
    if (state_.compare_exchange_weak(before, after)) {
      return true;
    }
    after = before;  // another thread has changed the state
  }
  return false;
}

}  // namespace franka_hw
