// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The supervisor's requests, and its transitions between modes.
#include <franka_sim/robot/limits.h>

#include <algorithm>
#include <cmath>

#include "robot/motion_supervisor.h"
#include "robot/transforms.h"

namespace franka_sim {

namespace codec = franka_core::fci;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

namespace {

// A generator needs an internal controller that follows it, or an external one; without a
// generator, the controller must be external.
bool areCompatible(const codec::MoveRequest& request) noexcept {
  if (request.motion_generator_mode == MotionGeneratorMode::kIdle ||
      request.controller_mode == ControllerMode::kOther) {
    return false;
  }
  return request.motion_generator_mode != MotionGeneratorMode::kNone ||
         (request.controller_mode == ControllerMode::kExternalController &&
          !request.use_async_motion_generator);
}

// Chosen here: the way of 100 ticks at this speed is below the resolution of the arm's sensors.
constexpr double kResting = 1e-4;  // [rad/s]

bool anyError(const franka_core::RobotState& state) noexcept {
  return std::any_of(state.errors.begin(), state.errors.end(), [](bool error) { return error; });
}

}  // namespace

// --- motions -------------------------------------------------------------------------------------

MotionSupervisor::Answer MotionSupervisor::handle(const codec::MoveRequest& request) noexcept {
  return fci_active_ ? startMotion(request) : Status::kCommandNotPossibleRejected;
}

MotionSupervisor::Answer MotionSupervisor::handle(const OperatorMove& request) noexcept {
  return startMotion(request.move);
}

MotionSupervisor::Answer MotionSupervisor::startMotion(const codec::MoveRequest& request) noexcept {
  const bool with_generator = request.motion_generator_mode != MotionGeneratorMode::kNone;
  if (!estimator_->started() || mode() != RobotMode::kIdle ||
      (with_generator && rest_.isBraking())) {
    return Status::kCommandNotPossibleRejected;
  }
  if (!areCompatible(request) || !isDeviation(request.max_path_deviation) ||
      !isDeviation(request.max_goal_deviation)) {
    return Status::kInvalidArgumentRejected;
  }
  if (with_generator) {
    switch (startGenerator(request)) {
      case MotionStartResult::kInvalidArgument:
        return Status::kInvalidArgumentRejected;
      case MotionStartResult::kSingular:
        answers_.motionEnds(Status::kStartAtSingularPoseRejected);
        return Status::kMotionStarted;
      case MotionStartResult::kStarted:
        break;
    }
  }
  atRest();  // a torque motion may start while the arm still brakes
  move_ = request;
  answers_.motionBegins();
  state_->reflex_reason.fill(false);
  change(ModeEvent::kMotionStarted);
  return Status::kMotionStarted;
}

MotionStartResult MotionSupervisor::startGenerator(const codec::MoveRequest& request) noexcept {
  MotionStart start;
  start.mode = request.motion_generator_mode;
  start.q_d = state_->q_d;
  start.F_T_EE = state_->F_T_EE;
  start.asynchronous = request.use_async_motion_generator;
  start.maximum_velocity = request.maximum_velocity;
  return generator_.start(start, configuration_->parameters().model);
}

MotionSupervisor::Answer MotionSupervisor::handle(const codec::StopMoveRequest& /*r*/) noexcept {
  if (!isMoving()) {
    return Status::kCommandNotPossibleRejected;
  }
  answers_.stopBegins();
  endMotion(ModeEvent::kMotionEnded, Status::kPreempted, true);
  return std::nullopt;
}

MotionSupervisor::Answer MotionSupervisor::handle(
    const codec::AutomaticErrorRecoveryRequest& /*request*/) noexcept {
  switch (mode()) {
    case RobotMode::kUserStopped:
      return Status::kManualErrorRecoveryRequiredRejected;
    case RobotMode::kOther:
      return Status::kCommandNotPossibleRejected;
    case RobotMode::kReflex:
      return recover();
    default:
      return recoverWithoutReflex();
  }
}

MotionSupervisor::Answer MotionSupervisor::recover() noexcept {
  if (beyondJointLimits(limits().arm, state_->q)) {
    return Status::kManualErrorRecoveryRequiredRejected;
  }
  answers_.recoveryBegins();
  recovery_ticks_ = 0;
  still_ticks_ = 0;
  change(ModeEvent::kRecoveryStarted);
  return std::nullopt;
}

// Refused by the FCI outside Idle; ros_control may request it at any time.
MotionSupervisor::Answer MotionSupervisor::recoverWithoutReflex() noexcept {
  if (configuration_->parameters().rules != InterfaceRules::kFci) {
    clearErrors();
    return Status::kSuccess;
  }
  return mode() == RobotMode::kIdle ? Status::kSuccess : Status::kCommandNotPossibleRejected;
}

MotionSupervisor::Answer MotionSupervisor::handle(const ClientLost& /*request*/) noexcept {
  move_.use_async_motion_generator = false;
  return Status::kSuccess;
}

// --- the operator --------------------------------------------------------------------------------

MotionSupervisor::Answer MotionSupervisor::handle(const UserStop& request) noexcept {
  user_stop_ = request.pressed;
  if (request.pressed) {
    endMotion(ModeEvent::kUserStopPressed, Status::kEmergencyAborted, false);
  } else {
    leaveStop(ModeEvent::kUserStopReleased);
  }
  return Status::kSuccess;
}

MotionSupervisor::Answer MotionSupervisor::handle(const Guiding& request) noexcept {
  if (request.active) {
    endMotion(ModeEvent::kGuidingStarted, Status::kAborted, false);
  } else if (change(ModeEvent::kGuidingEnded)) {
    settle();
  }
  return Status::kSuccess;
}

MotionSupervisor::Answer MotionSupervisor::handle(const Brakes& request) noexcept {
  brakes_requested_ = request.closed;
  if (request.closed) {
    endMotion(ModeEvent::kBrakesClosed, Status::kAborted, false);
  } else {
    leaveStop(ModeEvent::kBrakesOpened);
  }
  return Status::kSuccess;
}

MotionSupervisor::Answer MotionSupervisor::handle(const FciActivation& request) noexcept {
  fci_active_ = request.active;
  if (!request.active && isMoving()) {
    endMotion(ModeEvent::kMotionEnded, Status::kAborted, false);
  }
  return Status::kSuccess;
}

// --- configuration -------------------------------------------------------------------------------

bool MotionSupervisor::acceptsSetters() const noexcept {
  return !isMoving() || acceptsSettersInMotion(configuration_->parameters().rules);
}

MotionSupervisor::Answer MotionSupervisor::handle(
    const codec::SetGuidingModeRequest& request) noexcept {
  if (!acceptsSetters()) {
    return Status::kCommandNotPossibleRejected;
  }
  guiding_.free = request.guiding_mode;
  guiding_.elbow_free = request.nullspace;
  guideFromHere();
  law_switch_ = LawSwitch::kBlend;
  return Status::kSuccess;
}

MotionSupervisor::Answer MotionSupervisor::handle(
    const codec::SetFiltersRequest& request) noexcept {
  if (isMoving()) {
    return Status::kCommandNotPossibleRejected;
  }
  return filter_.set(request) ? Status::kSuccess : Status::kInvalidArgumentRejected;
}

MotionSupervisor::Answer MotionSupervisor::handle(const SetVirtualWall& request) noexcept {
  if (isMoving()) {
    return Status::kCommandNotPossibleRejected;
  }
  return safety_.walls().set(request.id, request.wall) ? Status::kSuccess
                                                       : Status::kInvalidArgumentRejected;
}

void MotionSupervisor::limitsChange() noexcept {
  generator_ =
      MotionGenerator(motionLimitsOfProtocol(configuration_->parameters().protocol_version));
}

UnitStatus MotionSupervisor::status() const noexcept {
  UnitStatus status;
  status.brakes_closed = brakesClosed();
  status.user_stop_pressed = user_stop_;
  status.fci_active = fci_active_;
  status.settling = !rest_.isFinished() || mode() == RobotMode::kAutomaticErrorRecovery ||
                    modes_.closesBrakes() != brakes_closed_;
  const std::array<double, 7>& dq = estimator_->estimate().dq;
  status.resting =
      std::all_of(dq.begin(), dq.end(), [](double v) { return std::abs(v) <= kResting; });
  status.answers_at_rest = answers_.waitForRest();
  status.thresholds = thresholds();
  status.joint_collision = safety_.jointCollision();
  status.cartesian_collision = safety_.cartesianCollision();
  status.self_collision = safety_.selfCollision();
  return status;
}

void MotionSupervisor::restart() noexcept {
  if (isMoving() && generates()) {
    endMotion(ModeEvent::kMotionEnded, Status::kAborted, false);
  }
  atRest();
  clearMotionData();
  law_switch_ = LawSwitch::kNone;
  still_ticks_ = 0;
  brakes_closed_ = modes_.closesBrakes();
}

// --- transitions ---------------------------------------------------------------------------------

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
  showModes();
  return true;
}

// Commands, losses and accelerations belong to one motion.
void MotionSupervisor::clearMotionData() noexcept {
  phase_.restart();
  accelerating_ = false;
  losses_.restart();
  safety_.lawChanges();
  torque_command_.clear();
}

void MotionSupervisor::enter(RobotMode before) noexcept {
  switch (mode()) {
    case RobotMode::kMove:
      enterMove();
      break;
    case RobotMode::kIdle:
    case RobotMode::kReflex:
      if (brakes_closed_) {
        holdPosition();
      } else if (before != RobotMode::kAutomaticErrorRecovery) {
        brake();
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
  brakes_closed_ = false;
}

// The user stop, or the brakes: an arm that moves is brought to rest first.
void MotionSupervisor::stopAndClose() noexcept {
  closing_ticks_ = 0;
  still_ticks_ = 0;
  if (brakes_closed_) {
    return;
  }
  brakes_closed_ = standsStill() && !rest_.isBraking();
  if (brakes_closed_) {
    holdPosition();
  } else {
    brake();
  }
}

// A stop that is released while the arm still brakes continues until the brakes are closed.
void MotionSupervisor::leaveStop(ModeEvent event) noexcept {
  const bool braking = modes_.closesBrakes() && !brakes_closed_;
  if (!braking && change(event)) {
    settle();
  }
}

void MotionSupervisor::enterMove() noexcept {
  rest_.finish();
  if (!generates()) {
    holdPosition();
  }
  if (controlledOutside()) {
    law_switch_ = LawSwitch::kFromZero;
  }
  safety_.motionBegins();
  filter_.begin(*state_);
}

// Leaves Idle again if the user stop is still pressed or an error remains.
void MotionSupervisor::settle() noexcept {
  if (hasReflexes()) {
    // The shock of closing brakes and the forces of guiding are not collisions.
    estimator_->clearContacts();
  }
  if (user_stop_) {
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
void MotionSupervisor::brake() noexcept {
  const bool desired = state_->motion_generator_mode != MotionGeneratorMode::kIdle &&
                       state_->motion_generator_mode != MotionGeneratorMode::kNone &&
                       state_->controller_mode != ControllerMode::kExternalController;
  if (desired || rest_.isBraking()) {
    rest_.brake(state_->q_d, state_->dq_d, state_->ddq_d, brakingLimits());
  } else {
    rest_.brake(state_->q, estimator_->estimate().dq, {}, brakingLimits());
  }
}

}  // namespace franka_sim
