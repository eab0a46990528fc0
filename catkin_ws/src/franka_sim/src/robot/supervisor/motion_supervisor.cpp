// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The supervisor's work in each tick. Its requests: motion_supervisor_requests.cpp; its transitions
// between modes: motion_supervisor_transitions.cpp.
#include "robot/supervisor/motion_supervisor.h"

#include <algorithm>
#include <cmath>

#include "robot/limits/deviation.h"

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotError;
using franka_core::RobotMode;

namespace {

constexpr double kStandstill = 0.01;  // [rad/s] slower joints stand still (decision 16)
// Chosen here: braking and yielding take less than 1 s, so a longer recovery has failed.
constexpr int kRecoveryTicks = 5000;

}  // namespace

MotionSupervisor::MotionSupervisor(const Configuration& configuration, StateEstimator& estimator,
                                   franka_core::RobotState& state) noexcept
    : configuration_(&configuration),
      estimator_(&estimator),
      state_(&state),
      safety_(configuration, estimator, state),
      motion_(franka_core::motionLimitsOfProtocol(configuration.parameters().protocol_version),
              configuration.parameters().max_torque),
      desired_(state) {
  writeModes();
}

const CollisionThresholds& MotionSupervisor::thresholds() const noexcept {
  const ControlUnitParameters& parameters = configuration_->parameters();
  return phase_.inAcceleration() ? parameters.acceleration : parameters.nominal;
}

// --- first half ----------------------------------------------------------------------------------

const CollisionThresholds& MotionSupervisor::beginTick() noexcept {
  phase_.step();
  return thresholds();
}

void MotionSupervisor::checkState(const std::array<double, 7>& motor_torques) noexcept {
  const Estimate& estimate = estimator_->estimate();
  if (estimate.first) {
    // The stored poses of the present mode become the present pose. The arm rests: a stop since the
    // restart is complete.
    holdPosition();
    answers_.atRest();
    guideFromHere();
    if (isMoving()) {
      safety_.motionBegins();
    }
  } else if (mode() == RobotMode::kGuiding) {
    holdPosition();
  }
  desired_.update(configuration_->parameters().model);
  if (hasReflexes() && estimate.measured && (mode() == RobotMode::kIdle || isMoving())) {
    safety_.check(limits(), thresholds());
    if (isMoving()) {
      safety_.checkMotion(motion_.request(), limits(), motor_torques);
    }
    react();
  }
  state_->control_command_success_rate = motion_.successRate();
}

// --- second half ---------------------------------------------------------------------------------

void MotionSupervisor::advance(const franka_core::RobotCommand* command) noexcept {
  if (isMoving()) {
    advanceMotion(command);
  }
  advanceRest();
  if (mode() == RobotMode::kAutomaticErrorRecovery) {
    advanceRecovery();
  }
  if (modes_.closesBrakes()) {
    advanceBrakes();
  }
}

ControlTask MotionSupervisor::takeTask() noexcept {
  ControlTask task;
  task.mode = mode();
  task.controller = motion_.request().controller_mode;
  task.tau = motion_.torque();
  task.guiding = guiding_;
  task.law_switch = law_switch_;
  law_switch_ = LawSwitch::kNone;
  return task;
}

void MotionSupervisor::advanceMotion(const franka_core::RobotCommand* command) noexcept {
  const ClientMotion::Step step =
      motion_.step(command, hasReflexes(), configuration_->parameters().model);
  safety_.raise(step.errors);
  if (step.generated) {
    desired_.set(motion_.desired());
    phase_.setAccelerating(motion_.desired().accelerating &&
                           !motion_.hasExternalController());  // (decision 15)
  }
  react();
  if (!step.finished || !isMoving()) {
    return;
  }
  if (hasReflexes() && generates() && !motion_.hasExternalController() &&
      deviates(*state_, motion_.request().max_goal_deviation)) {
    safety_.raise(RobotError::kMaxGoalPoseDeviationViolation);
    react();
    return;
  }
  endMotion(ModeEvent::kMotionEnded, Status::kSuccess, true);
}

void MotionSupervisor::advanceRest() noexcept {
  const bool reflex = mode() == RobotMode::kReflex || mode() == RobotMode::kAutomaticErrorRecovery;
  const RestSequence::Step step =
      rest_.step(reflex, state_->q, estimator_->estimate().dq, limits().arm);
  switch (step) {
    case RestSequence::Step::kNone:
      break;
    case RestSequence::Step::kYields:
      desired_.set(state_->q, {}, {});
      break;
    case RestSequence::Step::kBrakes:
      desired_.set(rest_.braking().q(), rest_.braking().dq(), rest_.braking().ddq());
      break;
    case RestSequence::Step::kStops:
      desired_.set(rest_.braking().q(), {}, {});
      answers_.atRest();
  }
}

void MotionSupervisor::advanceRecovery() noexcept {
  recovery_ticks_++;
  // The recovery need not wait for the end of the yield time if the arm no longer moves: the socket
  // of a client that does not read states meanwhile holds at most those of 50 ms, and the recovery
  // should be complete within them.
  if (brakes_.hasComeToRest(rests())) {
    clearErrors();
    answers_.recoveryEnds(Status::kSuccess);
    change(ModeEvent::kRecoveryEnded);
  } else if (recovery_ticks_ >= kRecoveryTicks) {
    answers_.recoveryEnds(Status::kAborted);
    change(ModeEvent::kRecoveryFailed);
  }
}

void MotionSupervisor::advanceBrakes() noexcept {
  if (brakes_.closed() || rest_.isBraking()) {
    return;
  }
  brakes_.step(rests());
  leaveReleasedStop();
}

bool MotionSupervisor::rests() const noexcept {
  const std::array<double, 7>& dq = estimator_->estimate().dq;
  return !rest_.isBraking() &&
         std::all_of(dq.begin(), dq.end(), [](double v) { return std::abs(v) < kStandstill; });
}

// --- the state -----------------------------------------------------------------------------------

void MotionSupervisor::holdPosition() noexcept {
  desired_.set(state_->q, {}, {});
  rest_.finish();
}

void MotionSupervisor::guideFromHere() noexcept {
  guiding_.O_T_EE = state_->O_T_EE;
  guiding_.q = state_->q;
}

void MotionSupervisor::writeModes() noexcept {
  state_->robot_mode = mode();
  state_->motion_generator_mode =
      isMoving() ? motion_.request().motion_generator_mode : MotionGeneratorMode::kIdle;
  state_->controller_mode = isMoving() ? motion_.request().controller_mode : ControllerMode::kOther;
  state_->control_command_success_rate = motion_.successRate();
  if (!isMoving()) {
    state_->tau_J_d.fill(0.0);
  }
}

}  // namespace franka_sim
