// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// What a ControlUnit is asked for, and what its transitions bring about.
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/deviation.h>
#include <franka_sim/robot/measured_limits.h>
#include <franka_sim/robot/parameter_checks.h>
#include <franka_sim/robot/transforms.h>

#include <algorithm>

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

namespace {

template <typename T>
std::optional<T> take(std::optional<T>& value) noexcept {
  const std::optional<T> taken = value;
  value.reset();
  return taken;
}

// A generator needs a controller that follows it, or one outside; no generator, one outside.
bool goTogether(const franka_core::fci::MoveRequest& request) noexcept {
  if (request.motion_generator_mode == MotionGeneratorMode::kIdle ||
      request.controller_mode == ControllerMode::kOther) {
    return false;
  }
  return request.motion_generator_mode != MotionGeneratorMode::kNone ||
         (request.controller_mode == ControllerMode::kExternalController &&
          !request.use_async_motion_generator);
}

}  // namespace

// --- motions -------------------------------------------------------------------------------------

ControlUnit::Status ControlUnit::startMotion(const MoveRequest& request) noexcept {
  const bool with_generator = request.motion_generator_mode != MotionGeneratorMode::kNone;
  if (!started_ || !fci_active_ || mode() != RobotMode::kIdle ||
      (with_generator && rest_ == Rest::kBraking)) {
    return Status::kCommandNotPossibleRejected;
  }
  if (!goTogether(request) || !isDeviation(request.max_path_deviation) ||
      !isDeviation(request.max_goal_deviation)) {
    return Status::kInvalidArgumentRejected;
  }
  if (with_generator) {
    MotionStart start;
    start.mode = request.motion_generator_mode;
    start.q_d = state_.q_d;
    start.F_T_EE = state_.F_T_EE;
    start.asynchronous = request.use_async_motion_generator;
    start.maximum_velocity = request.maximum_velocity;
    const MotionStartResult result = generator_.start(start, parameters_.model);
    if (result == MotionStartResult::kInvalidArgument) {
      return Status::kInvalidArgumentRejected;
    }
    if (result == MotionStartResult::kSingular) {
      motion_end_ = Status::kStartAtSingularPoseRejected;
      return Status::kMotionStarted;
    }
  }
  atRest();  // torques may overtake the braking of a motion
  move_ = request;
  motion_end_.reset();
  state_.reflex_reason.fill(false);
  handle(ModeEvent::kMotionStarted);
  return Status::kMotionStarted;
}

std::optional<ControlUnit::Status> ControlUnit::stopMove() noexcept {
  if (mode() != RobotMode::kMove) {
    return Status::kCommandNotPossibleRejected;
  }
  stop_end_.reset();
  stopping_ = true;
  endMotion(ModeEvent::kMotionEnded, Status::kPreempted, true);
  return std::nullopt;
}

std::optional<ControlUnit::Status> ControlUnit::takeMotionEnd() noexcept {
  return take(motion_end_);
}

std::optional<ControlUnit::Status> ControlUnit::takeStopEnd() noexcept { return take(stop_end_); }

std::optional<ControlUnit::Status> ControlUnit::takeRecoveryEnd() noexcept {
  return take(recovery_end_);
}

std::optional<ControlUnit::Status> ControlUnit::startErrorRecovery() noexcept {
  switch (mode()) {
    case RobotMode::kIdle:
      return Status::kSuccess;
    case RobotMode::kUserStopped:
      return Status::kManualErrorRecoveryRequiredRejected;
    case RobotMode::kReflex:
      break;
    default:
      return Status::kCommandNotPossibleRejected;
  }
  if (beyondJointLimits(generator_.limits().arm, state_.q)) {
    return Status::kManualErrorRecoveryRequiredRejected;
  }
  recovery_end_.reset();
  recovery_ticks_ = 0;
  still_ticks_ = 0;
  handle(ModeEvent::kRecoveryStarted);
  return std::nullopt;
}

bool ControlUnit::settling() const noexcept {
  return rest_ != Rest::kReached || modes_.mode() == RobotMode::kAutomaticErrorRecovery;
}

RequestStatus ControlUnit::startTorqueControl() noexcept {
  MoveRequest request;
  request.controller_mode = ControllerMode::kExternalController;
  request.motion_generator_mode = MotionGeneratorMode::kNone;
  return startMotion(request) == Status::kMotionStarted ? RequestStatus::kSuccess
                                                        : RequestStatus::kNotPossible;
}

RequestStatus ControlUnit::stopMotion() noexcept {
  if (mode() != RobotMode::kMove) {
    return RequestStatus::kNotPossible;
  }
  endMotion(ModeEvent::kMotionEnded, Status::kPreempted, true);
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::automaticErrorRecovery() noexcept {
  if (mode() == RobotMode::kReflex) {
    return startErrorRecovery() ? RequestStatus::kNotPossible : RequestStatus::kSuccess;
  }
  if (mode() == RobotMode::kUserStopped || mode() == RobotMode::kOther) {
    return RequestStatus::kNotPossible;
  }
  clearErrors();
  return RequestStatus::kSuccess;
}

// --- hands on the robot --------------------------------------------------------------------------

void ControlUnit::setUserStop(bool pressed) noexcept {
  user_stop_ = pressed;
  if (pressed) {
    endMotion(ModeEvent::kUserStopPressed, Status::kEmergencyAborted, false);
  } else if (handle(ModeEvent::kUserStopReleased)) {
    settle();
  }
}

void ControlUnit::setGuiding(bool active) noexcept {
  if (active) {
    endMotion(ModeEvent::kGuidingStarted, Status::kAborted, false);
  } else if (handle(ModeEvent::kGuidingEnded)) {
    settle();
  }
}

void ControlUnit::closeBrakes() noexcept {
  endMotion(ModeEvent::kBrakesClosed, Status::kAborted, false);
}

void ControlUnit::openBrakes() noexcept {
  if (handle(ModeEvent::kBrakesOpened)) {
    settle();
  }
}

void ControlUnit::setFciActive(bool active) noexcept {
  fci_active_ = active;
  if (!active && mode() == RobotMode::kMove) {
    endMotion(ModeEvent::kMotionEnded, Status::kAborted, false);
  }
}

// --- configuration -------------------------------------------------------------------------------

bool ControlUnit::settersAllowed() const noexcept {
  return parameters_.setters_in_motion || (modes_.mode() != RobotMode::kMove);
}

RequestStatus ControlUnit::setEE(const std::array<double, 16>& NE_T_EE) noexcept {
  if (!settersAllowed() || (mode() == RobotMode::kMove && generates())) {
    return RequestStatus::kNotPossible;
  }
  if (!isFrame(NE_T_EE)) {
    return RequestStatus::kInvalidArgument;
  }
  parameters_.NE_T_EE = NE_T_EE;
  showConfiguration();
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setK(const std::array<double, 16>& EE_T_K) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  if (!isFrame(EE_T_K)) {
    return RequestStatus::kInvalidArgument;
  }
  parameters_.EE_T_K = EE_T_K;
  showConfiguration();
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setLoad(const franka_core::Payload& load) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  if (!isPayload(load)) {
    return RequestStatus::kInvalidArgument;
  }
  parameters_.load = load;
  showConfiguration();
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setCollisionBehavior(const CollisionThresholds& acceleration,
                                                const CollisionThresholds& nominal) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  if (!areThresholds(acceleration) || !areThresholds(nominal)) {
    return RequestStatus::kInvalidArgument;
  }
  parameters_.acceleration = acceleration;
  parameters_.nominal = nominal;
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setJointImpedance(const std::array<double, 7>& K_theta) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  if (!isJointStiffness(K_theta)) {
    return RequestStatus::kInvalidArgument;
  }
  joint_controller_.setStiffness(K_theta);
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setCartesianImpedance(const std::array<double, 6>& K_x) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  if (!isCartesianStiffness(K_x)) {
    return RequestStatus::kInvalidArgument;
  }
  parameters_.cartesian_stiffness = K_x;
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setGuidingMode(const std::array<bool, 6>& free, bool elbow) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  guiding_free_ = free;
  guiding_elbow_ = elbow;
  guiding_pose_ = state_.O_T_EE;
  guiding_q_ = state_.q;
  blend_.lawChanges();
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setFilters(const franka_core::fci::SetFiltersRequest& cutoffs) noexcept {
  if (mode() == RobotMode::kMove) {
    return RequestStatus::kNotPossible;
  }
  return filter_.set(cutoffs) ? RequestStatus::kSuccess : RequestStatus::kInvalidArgument;
}

RequestStatus ControlUnit::setVirtualWall(std::int32_t id,
                                          const franka_core::fci::CartesianLimit& wall) noexcept {
  if (mode() == RobotMode::kMove) {
    return RequestStatus::kNotPossible;
  }
  return walls_.set(id, wall) ? RequestStatus::kSuccess : RequestStatus::kInvalidArgument;
}

RequestStatus ControlUnit::setProtocolVersion(unsigned version) noexcept {
  if (mode() == RobotMode::kMove) {
    return RequestStatus::kNotPossible;
  }
  if (version < 3 || version > 10) {
    return RequestStatus::kInvalidArgument;
  }
  parameters_.protocol_version = version;
  generator_ = MotionGenerator(motionLimitsOfProtocol(version));
  return RequestStatus::kSuccess;
}

void ControlUnit::restart() noexcept {
  if (mode() == RobotMode::kMove && generates()) {
    endMotion(ModeEvent::kMotionEnded, Status::kAborted, false);
  }
  atRest();
  started_ = false;
  continuous_ = false;
  tau_ext_filter_.restart();
  dtau_J_filter_.restart();
  joint_contacts_.clear();
  cartesian_contacts_.clear();
  torque_command_.clear();
  blend_.restart();
  phase_.restart();
  accelerating_ = false;
  losses_.restart();
  force_watch_.restart();
  still_ticks_ = 0;
}

// --- transitions ---------------------------------------------------------------------------------

void ControlUnit::flag(std::size_t error) noexcept { state_.errors[error] = true; }

// Errors end what runs.
void ControlUnit::react() noexcept {
  const bool wrong =
      std::any_of(state_.errors.begin(), state_.errors.end(), [](bool error) { return error; });
  if (wrong && (mode() == RobotMode::kMove || mode() == RobotMode::kIdle)) {
    state_.reflex_reason = state_.errors;
    endMotion(ModeEvent::kError, Status::kReflexAborted, false);
  }
}

// Any event that ends a motion if one runs; the status is the motion's and that of what still waits
// for rest: a stop, or a motion that the client has finished.
void ControlUnit::endMotion(ModeEvent event, Status status, bool at_rest) noexcept {
  const RobotMode before = mode();
  if (!handle(event)) {
    return;
  }
  if (before == RobotMode::kMove) {
    (at_rest ? motion_end_at_rest_ : motion_end_) = status;
  } else if (motion_end_at_rest_) {
    motion_end_ = motion_end_at_rest_ == Status::kSuccess ? status : motion_end_at_rest_;
    motion_end_at_rest_.reset();
  }
  if (stopping_ && !at_rest) {
    stop_end_ = status;
    stopping_ = false;
  }
  if (before == RobotMode::kAutomaticErrorRecovery) {
    recovery_end_ = status;
  }
}

// The arm has come to rest: those who wait for that are answered.
void ControlUnit::atRest() noexcept {
  rest_ = Rest::kReached;
  if (motion_end_at_rest_) {
    motion_end_ = motion_end_at_rest_;
    motion_end_at_rest_.reset();
  }
  if (stopping_) {
    stop_end_ = Status::kSuccess;
    stopping_ = false;
  }
}

bool ControlUnit::handle(ModeEvent event) noexcept {
  const RobotMode before = mode();
  if (!modes_.handle(event)) {
    return false;
  }
  enter(before);
  showModes();
  return true;
}

void ControlUnit::enter(RobotMode before) noexcept {
  blend_.lawChanges();
  phase_.restart();
  accelerating_ = false;
  losses_.restart();
  force_watch_.restart();
  torque_command_.clear();
  switch (mode()) {
    case RobotMode::kMove:
      rest_ = Rest::kReached;
      if (!generates()) {
        holdHere();
      }
      if (controlledOutside()) {
        blend_.lawStartsFromZero();
      }
      self_collision_.begin(parameters_.model, state_.q);
      walls_.begin(state_.O_T_EE);
      filter_.begin(state_);
      break;
    case RobotMode::kIdle:
    case RobotMode::kReflex:
      if (before == RobotMode::kUserStopped || before == RobotMode::kOther) {
        holdHere();
      } else if (before != RobotMode::kAutomaticErrorRecovery) {
        brake();
      }
      break;
    case RobotMode::kGuiding:
      guiding_pose_ = state_.O_T_EE;
      guiding_q_ = state_.q;
      holdHere();
      break;
    case RobotMode::kAutomaticErrorRecovery:
      break;
    default:
      holdHere();
  }
}

// Idle that cannot stay: the stop is still pressed, or an error has not been recovered from.
void ControlUnit::settle() noexcept {
  if (parameters_.reflexes) {
    // The shock of closing brakes, or the hands of the user, are no collisions.
    clearContacts();
  }
  if (user_stop_) {
    handle(ModeEvent::kUserStopPressed);
  } else if (std::any_of(state_.errors.begin(), state_.errors.end(), [](bool e) { return e; })) {
    handle(ModeEvent::kError);
  }
}

void ControlUnit::clearErrors() noexcept {
  state_.errors.fill(false);
  joint_collision_ = cartesian_collision_ = Collision();
  clearContacts();
}

void ControlUnit::clearContacts() noexcept {
  joint_contacts_.clear();
  cartesian_contacts_.clear();
  state_.joint_collision.fill(0.0);
  state_.cartesian_collision.fill(0.0);
}

// What is wanted of the arm comes to rest from where it is wanted now, or, if nobody wanted
// anything of its joints, from where it is.
void ControlUnit::brake() noexcept {
  const bool wanted = state_.motion_generator_mode != MotionGeneratorMode::kIdle &&
                      state_.motion_generator_mode != MotionGeneratorMode::kNone &&
                      state_.controller_mode != ControllerMode::kExternalController;
  if (wanted || rest_ == Rest::kBraking) {
    brake_.start(state_.q_d, state_.dq_d, generator_.limits().arm.ddq);
  } else {
    brake_.start(state_.q, state_.dq, generator_.limits().arm.ddq);
  }
  rest_ = Rest::kBraking;
  rest_ticks_ = 0;
}

void ControlUnit::holdHere() noexcept {
  state_.q_d = state_.q;
  state_.dq_d.fill(0.0);
  state_.ddq_d.fill(0.0);
  desired_stale_ = true;
  rest_ = Rest::kReached;
}

void ControlUnit::showDesired(const DesiredMotion& desired) noexcept {
  state_.q_d = desired.q_d;
  state_.dq_d = desired.dq_d;
  state_.ddq_d = desired.ddq_d;
  state_.O_T_EE_d = desired.O_T_EE_d;
  state_.O_T_EE_c = desired.O_T_EE_c;
  state_.O_dP_EE_d = desired.O_dP_EE_d;
  state_.O_dP_EE_c = desired.O_dP_EE_c;
  state_.O_ddP_EE_c = desired.O_ddP_EE_c;
  state_.elbow_d = desired.elbow_d;
  state_.elbow_c = desired.elbow_c;
  state_.delbow_c = desired.delbow_c;
  state_.ddelbow_c = desired.ddelbow_c;
  accelerating_ = desired.accelerating && !controlledOutside();  // (decision 15)
  desired_stale_ = false;
}

void ControlUnit::showModes() noexcept {
  const bool moving = mode() == RobotMode::kMove;
  state_.robot_mode = mode();
  state_.motion_generator_mode = moving ? move_.motion_generator_mode : MotionGeneratorMode::kIdle;
  state_.controller_mode = moving ? move_.controller_mode : ControllerMode::kOther;
  state_.control_command_success_rate = losses_.rate();
  if (!moving) {
    state_.tau_J_d.fill(0.0);
  }
}

void ControlUnit::showConfiguration() noexcept {
  const franka_core::Payload& ee = parameters_.end_effector;
  const franka_core::Payload& load = parameters_.load;
  total_ = franka_core::combine(ee, load);
  state_.F_T_NE = parameters_.F_T_NE;
  state_.NE_T_EE = parameters_.NE_T_EE;
  state_.EE_T_K = parameters_.EE_T_K;
  state_.F_T_EE = multiply(parameters_.F_T_NE, parameters_.NE_T_EE);
  state_.m_ee = ee.mass;
  state_.F_x_Cee = ee.com;
  state_.I_ee = ee.inertia;
  state_.m_load = load.mass;
  state_.F_x_Cload = load.com;
  state_.I_load = load.inertia;
  state_.m_total = total_.mass;
  state_.F_x_Ctotal = total_.com;
  state_.I_total = total_.inertia;
  state_.O_ddP_O = parameters_.gravity;
  desired_stale_ = true;
}

}  // namespace franka_sim
