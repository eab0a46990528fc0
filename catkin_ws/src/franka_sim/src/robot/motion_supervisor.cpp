// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The supervisor's work in each tick; requests and transitions: motion_supervisor_requests.cpp.
#include "robot/motion_supervisor.h"

#include <franka_core/finite.h>

#include <algorithm>
#include <cmath>

#include "robot/transforms.h"

namespace franka_sim {

using franka_core::ArmFrame;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotError;
using franka_core::RobotMode;

namespace {

constexpr double kStandstill = 0.01;  // [rad/s] slower joints stand still (decision 16)
constexpr int kStillTicks = 20;       // of standstill until a stop or a recovery ends
// Chosen here: braking and yielding take less than 1 s, so a longer recovery has failed.
constexpr int kRecoveryTicks = 5000;
// Chosen here: the time for the arm to come to rest after its desired motion. The brakes also close
// on an arm that something else still moves then.
constexpr int kClosingTicks = 100;

}  // namespace

MotionSupervisor::MotionSupervisor(const Configuration& configuration, StateEstimator& estimator,
                                   franka_core::RobotState& state) noexcept
    : configuration_(&configuration),
      estimator_(&estimator),
      state_(&state),
      safety_(configuration, estimator, state),
      generator_(motionLimitsOfProtocol(configuration.parameters().protocol_version)),
      torque_command_(configuration.parameters().max_torque) {
  showModes();
}

bool MotionSupervisor::generates() const noexcept {
  return move_.motion_generator_mode != MotionGeneratorMode::kNone;
}

bool MotionSupervisor::controlledOutside() const noexcept {
  return move_.controller_mode == ControllerMode::kExternalController;
}

const CollisionThresholds& MotionSupervisor::thresholds() const noexcept {
  const ControlUnitParameters& parameters = configuration_->parameters();
  return in_acceleration_ ? parameters.acceleration : parameters.nominal;
}

// --- first half ----------------------------------------------------------------------------------

const CollisionThresholds& MotionSupervisor::beginTick() noexcept {
  in_acceleration_ = phase_.update(accelerating_);
  return thresholds();
}

void MotionSupervisor::checkState(const std::array<double, 7>& motor_torques) noexcept {
  const Estimate& estimate = estimator_->estimate();
  if (estimate.first) {
    initializeFromMeasurement();
  } else if (mode() == RobotMode::kGuiding) {
    holdPosition();
  }
  updateDesired();
  if (hasReflexes() && estimate.measured && (mode() == RobotMode::kIdle || isMoving())) {
    safety_.check(limits(), thresholds());
    if (isMoving()) {
      safety_.checkMotion(move_, limits(), motor_torques);
    }
    react();
  }
  state_->control_command_success_rate = losses_.rate();
}

// Sets the stored poses of the present mode to the present pose.
void MotionSupervisor::initializeFromMeasurement() noexcept {
  holdPosition();
  guideFromHere();
  if (isMoving()) {
    safety_.motionBegins();
  }
}

// For states in which no generator sets these fields: at rest or braking.
void MotionSupervisor::updateDesired() noexcept {
  if (!desired_stale_) {
    return;
  }
  desired_stale_ = false;
  const franka_core::ArmModel& model = configuration_->parameters().model;
  state_->O_T_EE_d =
      model.pose(ArmFrame::kEndEffector, state_->q_d, state_->F_T_EE, state_->EE_T_K);
  state_->O_T_EE_c = state_->O_T_EE_d;
  state_->O_dP_EE_d.fill(0.0);
  if (state_->dq_d != std::array<double, 7>{}) {
    state_->O_dP_EE_d = twist(
        model.zeroJacobian(ArmFrame::kEndEffector, state_->q_d, state_->F_T_EE, state_->EE_T_K),
        state_->dq_d);
  }
  state_->O_dP_EE_c = state_->O_dP_EE_d;
  state_->O_ddP_EE_c.fill(0.0);
  state_->elbow_d = elbowOf(state_->q_d);
  state_->elbow_c = state_->elbow_d;
  state_->delbow_c = {{state_->dq_d[2], 0.0}};
  state_->ddelbow_c = {{state_->ddq_d[2], 0.0}};
}

// --- second half ---------------------------------------------------------------------------------

void MotionSupervisor::advance(const franka_core::RobotCommand* command) noexcept {
  if (isMoving()) {
    advanceMotion(receive(command));
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
  task.controller = move_.controller_mode;
  task.tau = torque_command_.value();
  task.guiding = guiding_;
  task.law_switch = law_switch_;
  law_switch_ = LawSwitch::kNone;
  return task;
}

// The filtered command; nullptr if none arrived or if, without reflexes, its torques are not
// finite.
const franka_core::RobotCommand* MotionSupervisor::receive(
    const franka_core::RobotCommand* command) noexcept {
  if (command != nullptr && !hasReflexes() && !franka_core::allFinite(command->tau_J_d)) {
    command = nullptr;
  }
  const bool due = !move_.use_async_motion_generator;
  if ((due || command != nullptr) && losses_.record(command != nullptr) && hasReflexes()) {
    safety_.raise(RobotError::kCommunicationConstraintsViolation);
  }
  return command == nullptr ? nullptr : &filter_.apply(*command);
}

void MotionSupervisor::advanceMotion(const franka_core::RobotCommand* command) noexcept {
  const bool finished = generates() ? advanceGenerator(command)
                                    : command != nullptr && command->torque_command_finished;
  if (controlledOutside() && command != nullptr && !takeTorque(*command)) {
    safety_.raise(RobotError::kControllerTorqueDiscontinuity);
  }
  react();
  if (finished && isMoving()) {
    finishMotion();
  }
}

bool MotionSupervisor::advanceGenerator(const franka_core::RobotCommand* command) noexcept {
  const MotionStep step = generator_.step(command, configuration_->parameters().model);
  if (step.errors) {
    safety_.raise(step.errors);
    return false;
  }
  showDesired(generator_.desired());
  return step.finished;
}

bool MotionSupervisor::takeTorque(const franka_core::RobotCommand& command) noexcept {
  if (hasReflexes() && torque_command_.jumps(command.tau_J_d)) {
    return false;
  }
  return torque_command_.receive(command.tau_J_d);
}

void MotionSupervisor::finishMotion() noexcept {
  if (hasReflexes() && generates() && !controlledOutside() &&
      deviates(*state_, move_.max_goal_deviation)) {
    safety_.raise(RobotError::kMaxGoalPoseDeviationViolation);
    react();
    return;
  }
  endMotion(ModeEvent::kMotionEnded, Status::kSuccess, true);
}

void MotionSupervisor::advanceRest() noexcept {
  const bool reflex = mode() == RobotMode::kReflex || mode() == RobotMode::kAutomaticErrorRecovery;
  const RestSequence::Step step =
      rest_.step(reflex, state_->q, estimator_->estimate().dq, brakingLimits());
  switch (step) {
    case RestSequence::Step::kNone:
      break;
    case RestSequence::Step::kYields:
      followArm();
      break;
    case RestSequence::Step::kBrakes:
      showJoints(rest_.braking().q(), rest_.braking().dq(), rest_.braking().ddq());
      break;
    case RestSequence::Step::kStops:
      showJoints(rest_.braking().q(), {}, {});
      answers_.atRest();
  }
}

void MotionSupervisor::advanceRecovery() noexcept {
  recovery_ticks_++;
  // The recovery need not wait for the end of the yield time if the arm no longer moves: the socket
  // of a client that does not read states meanwhile holds at most those of 50 ms, and the recovery
  // should be complete within them.
  if (hasComeToRest()) {
    clearErrors();
    answers_.recoveryEnds(Status::kSuccess);
    change(ModeEvent::kRecoveryEnded);
  } else if (recovery_ticks_ >= kRecoveryTicks) {
    answers_.recoveryEnds(Status::kAborted);
    change(ModeEvent::kRecoveryFailed);
  }
}

// A stop of category 1 (IEC 60204-1): the motors bring the arm to rest, then the brakes close. They
// wait for the end of what still swings: 0.01 rad/s stopped in one tick are 7 Nm at the first
// joint.
void MotionSupervisor::advanceBrakes() noexcept {
  if (brakes_closed_ || rest_.isBraking()) {
    return;
  }
  closing_ticks_++;
  brakes_closed_ = hasComeToRest() || closing_ticks_ >= kClosingTicks;
  if (mode() == RobotMode::kUserStopped && !user_stop_) {
    leaveStop(ModeEvent::kUserStopReleased);
  } else if (mode() == RobotMode::kOther && !brakes_requested_) {
    leaveStop(ModeEvent::kBrakesOpened);
  }
}

bool MotionSupervisor::hasComeToRest() noexcept {
  still_ticks_ = !rest_.isBraking() && standsStill() ? still_ticks_ + 1 : 0;
  return still_ticks_ >= kStillTicks;
}

bool MotionSupervisor::standsStill() const noexcept {
  const std::array<double, 7>& dq = estimator_->estimate().dq;
  return std::all_of(dq.begin(), dq.end(), [](double v) { return std::abs(v) < kStandstill; });
}

// --- what the state shows ------------------------------------------------------------------------

void MotionSupervisor::holdPosition() noexcept {
  followArm();
  rest_.finish();
}

void MotionSupervisor::followArm() noexcept { showJoints(state_->q, {}, {}); }

void MotionSupervisor::showJoints(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                  const std::array<double, 7>& ddq) noexcept {
  state_->q_d = q;
  state_->dq_d = dq;
  state_->ddq_d = ddq;
  desired_stale_ = true;
}

void MotionSupervisor::guideFromHere() noexcept {
  guiding_.O_T_EE = state_->O_T_EE;
  guiding_.q = state_->q;
}

void MotionSupervisor::showDesired(const DesiredMotion& desired) noexcept {
  state_->q_d = desired.q_d;
  state_->dq_d = desired.dq_d;
  state_->ddq_d = desired.ddq_d;
  state_->O_T_EE_d = desired.O_T_EE_d;
  state_->O_T_EE_c = desired.O_T_EE_c;
  state_->O_dP_EE_d = desired.O_dP_EE_d;
  state_->O_dP_EE_c = desired.O_dP_EE_c;
  state_->O_ddP_EE_c = desired.O_ddP_EE_c;
  state_->elbow_d = desired.elbow_d;
  state_->elbow_c = desired.elbow_c;
  state_->delbow_c = desired.delbow_c;
  state_->ddelbow_c = desired.ddelbow_c;
  accelerating_ = desired.accelerating && !controlledOutside();  // (decision 15)
  desired_stale_ = false;
}

void MotionSupervisor::showModes() noexcept {
  state_->robot_mode = mode();
  state_->motion_generator_mode =
      isMoving() ? move_.motion_generator_mode : MotionGeneratorMode::kIdle;
  state_->controller_mode = isMoving() ? move_.controller_mode : ControllerMode::kOther;
  state_->control_command_success_rate = losses_.rate();
  if (!isMoving()) {
    state_->tau_J_d.fill(0.0);
  }
}

}  // namespace franka_sim
