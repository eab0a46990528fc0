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
constexpr int kRestingTicks = 20;     // of standstill until a stop or a recovery ends
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
      motion_(motionLimitsOfProtocol(configuration.parameters().protocol_version),
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

void DesiredState::set(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                       const std::array<double, 7>& ddq_d) noexcept {
  state_->q_d = q_d;
  state_->dq_d = dq_d;
  state_->ddq_d = ddq_d;
  stale_ = true;
}

void DesiredState::set(const DesiredMotion& desired) noexcept {
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
  stale_ = false;
}

// For states in which no generator sets these fields: at rest or braking.
void DesiredState::update(const franka_core::ArmModel& model) noexcept {
  if (!stale_) {
    return;
  }
  stale_ = false;
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

bool ClientMotion::hasGenerator() const noexcept {
  return request_.motion_generator_mode != MotionGeneratorMode::kNone;
}

bool ClientMotion::hasExternalController() const noexcept {
  return request_.controller_mode == ControllerMode::kExternalController;
}

MotionStartResult ClientMotion::start(const franka_core::fci::MoveRequest& request, bool continued,
                                      const franka_core::RobotState& state,
                                      const franka_core::ArmModel& model) noexcept {
  if (request.motion_generator_mode != MotionGeneratorMode::kNone) {
    MotionStart start;
    start.mode = request.motion_generator_mode;
    start.q_d = state.q_d;
    start.F_T_EE = state.F_T_EE;
    start.continued = continued;
    start.asynchronous = request.use_async_motion_generator;
    start.maximum_velocity = request.maximum_velocity;
    const MotionStartResult result = generator_.start(start, model);
    if (result != MotionStartResult::kStarted) {
      return result;
    }
  }
  request_ = request;
  return MotionStartResult::kStarted;
}

ClientMotion::Step ClientMotion::step(const franka_core::RobotCommand* command, bool reflexes,
                                      const franka_core::ArmModel& model) noexcept {
  Step step;
  if (command != nullptr && !reflexes && !franka_core::allFinite(command->tau_J_d)) {
    command = nullptr;
  }
  const bool due = !request_.use_async_motion_generator;
  if ((due || command != nullptr) && losses_.record(command != nullptr) && reflexes) {
    step.errors.add(RobotError::kCommunicationConstraintsViolation);
  }
  if (command != nullptr) {
    command = &filter_.apply(*command);
  }
  if (hasGenerator()) {
    const MotionStep motion = generator_.step(command, model);
    step.errors.add(motion.errors);
    step.generated = !motion.errors;
    step.finished = step.generated && motion.finished;
  } else {
    step.finished = command != nullptr && command->torque_command_finished;
  }
  if (hasExternalController() && command != nullptr) {
    const bool jumps = reflexes && torque_.jumps(command->tau_J_d);
    step.errors.addIf(jumps || !torque_.receive(command->tau_J_d),
                      RobotError::kControllerTorqueDiscontinuity);
  }
  return step;
}

void ClientMotion::clear() noexcept {
  losses_.restart();
  torque_.clear();
}

void JointBrakes::close(bool rests) noexcept {
  ticks_ = 0;
  resting_ticks_ = 0;
  closed_ = closed_ || rests;
}

bool JointBrakes::hasComeToRest(bool rests) noexcept {
  resting_ticks_ = rests ? resting_ticks_ + 1 : 0;
  return resting_ticks_ >= kRestingTicks;
}

// They wait for the end of what still swings: 0.01 rad/s stopped in one tick are 7 Nm at the first
// joint.
void JointBrakes::step(bool rests) noexcept {
  ticks_++;
  closed_ = hasComeToRest(rests) || ticks_ >= kClosingTicks;
}

void JointBrakes::restart(bool closed) noexcept {
  resting_ticks_ = 0;
  closed_ = closed;
}

}  // namespace franka_sim
