// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The supervisor's requests and its status.
#include <franka_core/motion_limits.h>

#include <algorithm>
#include <cmath>

#include "robot/limits/deviation.h"
#include "robot/limits/measured_limits.h"
#include "robot/motion/inverse_kinematics.h"
#include "robot/supervisor/motion_supervisor.h"

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

}  // namespace

// --- motions -------------------------------------------------------------------------------------

MotionSupervisor::Answer MotionSupervisor::handle(const codec::MoveRequest& request) noexcept {
  return operator_.fci_active ? startMotion(request, false) : Status::kCommandNotPossibleRejected;
}

MotionSupervisor::Answer MotionSupervisor::handle(const OperatorMove& request) noexcept {
  return startMotion(request.move, false);
}

MotionSupervisor::Answer MotionSupervisor::handle(const ContinuedMove& request) noexcept {
  return operator_.fci_active ? startMotion(request.move, true)
                              : Status::kCommandNotPossibleRejected;
}

MotionSupervisor::Answer MotionSupervisor::startMotion(const codec::MoveRequest& request,
                                                       bool continued) noexcept {
  const bool with_generator = request.motion_generator_mode != MotionGeneratorMode::kNone;
  if (!estimator_->started() || mode() != RobotMode::kIdle ||
      (with_generator && rest_.isBraking())) {
    return Status::kCommandNotPossibleRejected;
  }
  if (!areCompatible(request) || !isDeviation(request.max_path_deviation) ||
      !isDeviation(request.max_goal_deviation)) {
    return Status::kInvalidArgumentRejected;
  }
  switch (motion_.start(request, continued, *state_, configuration_->parameters().model)) {
    case MotionStartResult::kInvalidArgument:
      return Status::kInvalidArgumentRejected;
    case MotionStartResult::kSingular:
      answers_.motionEnds(Status::kStartAtSingularPoseRejected);
      return Status::kMotionStarted;
    case MotionStartResult::kStarted:
      break;
  }
  atRest();  // a torque motion may start while the arm still brakes
  answers_.motionBegins();
  state_->reflex_reason.fill(false);
  change(ModeEvent::kMotionStarted);
  return Status::kMotionStarted;
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
      break;
  }
  // Refused by the FCI outside Idle; ros_control may request it at any time.
  if (configuration_->parameters().rules != InterfaceRules::kFci) {
    clearErrors();
    return Status::kSuccess;
  }
  return mode() == RobotMode::kIdle ? Status::kSuccess : Status::kCommandNotPossibleRejected;
}

MotionSupervisor::Answer MotionSupervisor::recover() noexcept {
  if (beyondJointLimits(limits().arm, state_->q)) {
    return Status::kManualErrorRecoveryRequiredRejected;
  }
  answers_.recoveryBegins();
  recovery_ticks_ = 0;
  brakes_.restart(brakes_.closed());
  change(ModeEvent::kRecoveryStarted);
  return std::nullopt;
}

MotionSupervisor::Answer MotionSupervisor::handle(const ClientLost& /*request*/) noexcept {
  motion_.clientIsLost();
  return Status::kSuccess;
}

// --- the operator --------------------------------------------------------------------------------

MotionSupervisor::Answer MotionSupervisor::handle(const UserStop& request) noexcept {
  operator_.user_stop = request.pressed;
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
  operator_.close_brakes = request.closed;
  if (request.closed) {
    endMotion(ModeEvent::kBrakesClosed, Status::kAborted, false);
  } else {
    leaveStop(ModeEvent::kBrakesOpened);
  }
  return Status::kSuccess;
}

MotionSupervisor::Answer MotionSupervisor::handle(const FciActivation& request) noexcept {
  operator_.fci_active = request.active;
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
  return motion_.filter().set(request) ? Status::kSuccess : Status::kInvalidArgumentRejected;
}

MotionSupervisor::Answer MotionSupervisor::handle(const SetVirtualWall& request) noexcept {
  if (isMoving()) {
    return Status::kCommandNotPossibleRejected;
  }
  return safety_.walls().set(request.id, request.wall) ? Status::kSuccess
                                                       : Status::kInvalidArgumentRejected;
}

void MotionSupervisor::limitsChange() noexcept {
  motion_.setLimits(
      franka_core::motionLimitsOfProtocol(configuration_->parameters().protocol_version));
}

UnitStatus MotionSupervisor::status() const noexcept {
  UnitStatus status;
  status.brakes_closed = brakesClosed();
  status.close_brakes = operator_.close_brakes;
  status.user_stop_pressed = operator_.user_stop;
  status.fci_active = operator_.fci_active;
  status.measured = estimator_->started();
  status.settling = !rest_.isFinished() || mode() == RobotMode::kAutomaticErrorRecovery ||
                    modes_.closesBrakes() != brakesClosed();
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

// The stop is computed in advance on a copy.
bool MotionSupervisor::stopsAtSingularPose() const noexcept {
  RestSequence rest = rest_;
  if (isMoving()) {
    brake(rest);
  }
  return InverseKinematics::isSingular(rest.isBraking() ? rest.restingPosition() : state_->q_d,
                                       state_->F_T_EE, configuration_->parameters().model);
}

void MotionSupervisor::restart() noexcept {
  if (isMoving() && generates()) {
    endMotion(ModeEvent::kMotionEnded, Status::kAborted, false);
  }
  atRest();
  clearMotionData();
  law_switch_ = LawSwitch::kNone;
  brakes_.restart(modes_.closesBrakes());
  leaveReleasedStop();
}

}  // namespace franka_sim
