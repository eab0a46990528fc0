// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The supervisor's transitions between modes, and what they begin and end.
#include <algorithm>

#include "robot/supervisor/motion_supervisor.h"

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

namespace {

bool anyError(const franka_core::RobotState& state) noexcept {
  return std::any_of(state.errors.begin(), state.errors.end(), [](bool error) { return error; });
}

}  // namespace

// Errors end a running motion.
void MotionSupervisor::react() noexcept {
  if (anyError(*state_) && (isMoving() || mode() == RobotMode::kIdle)) {
    state_->reflex_reason = state_->errors;
    endMotion(ModeEvent::kError, Status::kReflexAborted, false);
  }
}

// Handles any event that ends a motion if one runs. The status is for the motion and for requests
// that still wait for rest: a stop, or a motion that the client has finished.
void MotionSupervisor::endMotion(ModeEvent event, Status status, bool at_rest) noexcept {
  const RobotMode before = mode();
  if (!change(event)) {
    return;
  }
  if (before != RobotMode::kMove) {
    answers_.interruptMotion(status);
  } else if (at_rest) {
    answers_.motionEndsAtRest(status);
  } else {
    answers_.motionEnds(status);
  }
  if (!at_rest) {
    answers_.interruptStop(status);
  }
  if (before == RobotMode::kAutomaticErrorRecovery) {
    answers_.recoveryEnds(status);
  }
}

void MotionSupervisor::atRest() noexcept {
  rest_.finish();
  answers_.atRest();
}

bool MotionSupervisor::change(ModeEvent event) noexcept {
  const RobotMode before = mode();
  if (!modes_.handle(event)) {
    return false;
  }
  law_switch_ = LawSwitch::kBlend;
  clearMotionData();
  enter(before);
  writeModes();
  return true;
}

// Commands, losses and accelerations belong to one motion.
void MotionSupervisor::clearMotionData() noexcept {
  phase_.restart();
  motion_.clear();
  safety_.lawChanges();
}

void MotionSupervisor::enter(RobotMode before) noexcept {
  switch (mode()) {
    case RobotMode::kMove:
      rest_.finish();
      if (!generates()) {
        holdPosition();
      }
      if (motion_.hasExternalController()) {
        law_switch_ = LawSwitch::kFromZero;
      }
      safety_.motionBegins();
      motion_.beginFilters(*state_);
      break;
    case RobotMode::kIdle:
    case RobotMode::kReflex:
      if (brakesClosed()) {
        holdPosition();
      } else if (before != RobotMode::kAutomaticErrorRecovery) {
        brake(rest_);
      }
      break;
    case RobotMode::kGuiding:
      guideFromHere();
      holdPosition();
      break;
    case RobotMode::kAutomaticErrorRecovery:
      break;
    default:
      stopAndClose();
      return;
  }
  brakes_.open();
}

// The user stop, or the brakes: an arm that moves is brought to rest first.
void MotionSupervisor::stopAndClose() noexcept {
  const bool were_closed = brakesClosed();
  brakes_.close(rests());
  if (were_closed) {
    return;
  }
  if (brakesClosed()) {
    holdPosition();
  } else {
    brake(rest_);
  }
}

// A stop that is released while the arm still brakes continues until the brakes are closed.
void MotionSupervisor::leaveStop(ModeEvent event) noexcept {
  const bool braking = modes_.closesBrakes() && !brakesClosed();
  if (!braking && change(event)) {
    settle();
  }
}

// What was released while the arm still braked.
void MotionSupervisor::leaveReleasedStop() noexcept {
  if (mode() == RobotMode::kUserStopped && !operator_.user_stop) {
    leaveStop(ModeEvent::kUserStopReleased);
  } else if (mode() == RobotMode::kOther && !operator_.close_brakes) {
    leaveStop(ModeEvent::kBrakesOpened);
  }
}

// Leaves Idle again if the user stop is still pressed or an error remains.
void MotionSupervisor::settle() noexcept {
  if (hasReflexes()) {
    // The shock of closing brakes and the forces of guiding are not collisions.
    estimator_->clearContacts();
  }
  if (operator_.user_stop) {
    change(ModeEvent::kUserStopPressed);
  } else if (anyError(*state_)) {
    change(ModeEvent::kError);
  }
}

void MotionSupervisor::clearErrors() noexcept {
  state_->errors.fill(false);
  safety_.clearCollisions();
  estimator_->clearContacts();
}

// Brakes the desired motion; without one, the measured motion.
void MotionSupervisor::brake(RestSequence& rest) const noexcept {
  const bool desired = state_->motion_generator_mode != MotionGeneratorMode::kIdle &&
                       state_->motion_generator_mode != MotionGeneratorMode::kNone &&
                       state_->controller_mode != ControllerMode::kExternalController;
  if (desired || rest.isBraking()) {
    rest.brake(state_->q_d, state_->dq_d, state_->ddq_d, limits().arm);
  } else {
    rest.brake(state_->q, estimator_->estimate().dq, {}, limits().arm);
  }
}

}  // namespace franka_sim
