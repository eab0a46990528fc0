// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The second half of a tick: from a command to torques.
#include <franka_core/finite.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/deviation.h>
#include <franka_sim/robot/friction.h>
#include <franka_sim/robot/measured_limits.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

namespace {

constexpr int kReleaseTicks = 200;    // after a reflex the arm yields so long (decision 16)
constexpr int kReflexTicks = 200;     // then braking restarts (decision 16)
constexpr double kStandstill = 0.01;  // [rad/s] of a recovery's end (decision 16)
constexpr int kStillTicks = 20;       // so long below it
// Chosen here: braking and yielding take less than 1 s, so a recovery that takes longer has failed.
constexpr int kRecoveryTicks = 5000;
// [Nm/rad] where the elbow is not free. Chosen here: the hold of a locked elbow is not published.
constexpr double kGuidingNullspace = 200.0;

}  // namespace

const std::array<double, 7>& ControlUnit::actuate(
    const franka_core::RobotCommand* command) noexcept {
  if (mode() == RobotMode::kMove) {
    advanceMotion(command);
  }
  advanceRest();
  if (mode() == RobotMode::kAutomaticErrorRecovery) {
    advanceRecovery();
  }
  if (brakesClosed() || !started_) {
    blend_.restart();
    motor_torque_.fill(0.0);
    return motor_torque_;
  }
  law_ = saturate(controlLaw(), parameters_.max_torque);
  state_.tau_J_d = mode() == RobotMode::kMove ? law_ : std::array<double, 7>{};
  const std::array<double, 7> tau = blend_.apply(law_);
  const std::array<double, 7> friction =
      frictionCompensation(parameters_.coulomb_friction, parameters_.viscous_friction, state_.dq);
  std::array<double, 7> compensation;
  for (std::size_t i = 0; i < 7; i++) {
    compensation[i] = dynamics_.gravity[i] + friction[i];
  }
  // What is configured may be heavier than what a motor can hold.
  compensation = saturate(compensation, parameters_.max_torque);
  for (std::size_t i = 0; i < 7; i++) {
    motor_torque_[i] = tau[i] + compensation[i];
  }
  return motor_torque_;
}

// --- Move ----------------------------------------------------------------------------------------

bool ControlUnit::generates() const noexcept {
  return move_.motion_generator_mode != MotionGeneratorMode::kNone;
}

bool ControlUnit::controlledOutside() const noexcept {
  return move_.controller_mode == ControllerMode::kExternalController;
}

void ControlUnit::advanceMotion(const franka_core::RobotCommand* received) noexcept {
  const franka_core::RobotCommand* command = received;
  if (command != nullptr && !parameters_.reflexes && !franka_core::allFinite(command->tau_J_d)) {
    command = nullptr;
  }
  const bool due = !move_.use_async_motion_generator;
  if ((due || command != nullptr) && losses_.record(command != nullptr) && parameters_.reflexes) {
    flag(indexOf(ErrorFlag::kCommunication));
  }
  if (command != nullptr) {
    command = &filter_.apply(*command);
  }
  bool finished = false;
  if (generates()) {
    const MotionStep step = generator_.step(command, parameters_.model);
    if (step.fault) {
      flag(indexOf(*step.fault));
    } else {
      showDesired(generator_.desired());
      finished = step.finished;
    }
  } else {
    finished = command != nullptr && command->torque_command_finished;
  }
  if (controlledOutside() && command != nullptr && !takeTorque(*command)) {
    flag(indexOf(ErrorFlag::kTorqueDiscontinuity));
  }
  react();
  if (finished && mode() == RobotMode::kMove) {
    finishMotion();
  }
}

bool ControlUnit::takeTorque(const franka_core::RobotCommand& command) noexcept {
  if (parameters_.reflexes && torque_command_.jumps(command.tau_J_d)) {
    return false;
  }
  return torque_command_.receive(command.tau_J_d);
}

void ControlUnit::finishMotion() noexcept {
  if (parameters_.reflexes && generates() && !controlledOutside() &&
      deviates(state_, move_.max_goal_deviation)) {
    flag(indexOf(ErrorFlag::kGoalDeviation));
    react();
    return;
  }
  endMotion(ModeEvent::kMotionEnded, Status::kSuccess, true);
}

// --- coming to rest ------------------------------------------------------------------------------

void ControlUnit::advanceRest() noexcept {
  if (rest_ == Rest::kReleasing) {
    // The desired pose follows the measured one, damped, until nothing presses (decision 16).
    holdHere();
    rest_ = ++rest_ticks_ < kReleaseTicks ? Rest::kReleasing : Rest::kReached;
  }
  if (rest_ != Rest::kBraking) {
    return;
  }
  brake_.step();
  rest_ticks_++;
  const bool reflex = mode() == RobotMode::kReflex || mode() == RobotMode::kAutomaticErrorRecovery;
  if (reflex && rest_ticks_ == kReflexTicks && !brake_.atRest()) {
    // From here on the arm does not press on what it has met (decision 16).
    brake_.start(state_.q, state_.dq, generator_.limits().arm.ddq);
  }
  state_.q_d = brake_.q();
  state_.dq_d = brake_.dq();
  state_.ddq_d = brake_.ddq();
  desired_stale_ = true;
  if (!brake_.atRest()) {
    return;
  }
  atRest();
  if (reflex) {
    rest_ = Rest::kReleasing;
    rest_ticks_ = 0;
  }
}

void ControlUnit::advanceRecovery() noexcept {
  recovery_ticks_++;
  // An arm that yields after a reflex but no longer moves need not go on waiting: a client that
  // does not read states meanwhile finds those of 50 ms at most in its socket, and these should be
  // over.
  const bool still =
      rest_ != Rest::kBraking && std::all_of(state_.dq.begin(), state_.dq.end(),
                                             [](double dq) { return std::abs(dq) < kStandstill; });
  still_ticks_ = still ? still_ticks_ + 1 : 0;
  if (still_ticks_ >= kStillTicks) {
    clearErrors();
    recovery_end_ = Status::kSuccess;
    handle(ModeEvent::kRecoveryEnded);
  } else if (recovery_ticks_ >= kRecoveryTicks) {
    recovery_end_ = Status::kAborted;
    handle(ModeEvent::kRecoveryFailed);
  }
}

// --- control laws --------------------------------------------------------------------------------

std::array<double, 7> ControlUnit::controlLaw() noexcept {
  if (mode() == RobotMode::kGuiding) {
    std::array<double, 6> K;
    for (std::size_t i = 0; i < 6; i++) {
      K[i] = guiding_free_[i] ? 0.0 : (i < 3 ? 3000.0 : 300.0);
    }
    return cartesianLaw(K, guiding_elbow_ ? 0.0 : kGuidingNullspace);
  }
  if (mode() != RobotMode::kMove) {
    // Holds a pose that was latched when the mode began (decision 6).
    return hold_.torque(state_.q_d, state_.dq_d, state_.q, state_.dq, dynamics_.mass,
                        dynamics_.coriolis);
  }
  switch (move_.controller_mode) {
    case ControllerMode::kExternalController:
      return torque_command_.value();
    case ControllerMode::kCartesianImpedance:
      return cartesianLaw(parameters_.cartesian_stiffness, 10.0);
    default:
      return joint_controller_.torque(state_.q_d, state_.dq_d, state_.q, state_.dq, dynamics_.mass,
                                      dynamics_.coriolis);
  }
}

std::array<double, 7> ControlUnit::cartesianLaw(const std::array<double, 6>& K,
                                                double nullspace) const noexcept {
  const bool guiding = modes_.mode() == RobotMode::kGuiding;
  CartesianImpedanceInput in;
  in.O_T_EE_d = guiding ? guiding_pose_ : state_.O_T_EE_d;
  in.O_T_EE = state_.O_T_EE;
  in.EE_T_K = state_.EE_T_K;
  in.O_dP_EE_d = guiding ? std::array<double, 6>{} : state_.O_dP_EE_d;
  in.O_J_EE = dynamics_.zero_jacobian;
  in.mass = dynamics_.mass;
  in.q_d = guiding ? guiding_q_ : state_.q_d;
  in.q = state_.q;
  in.dq = state_.dq;
  in.coriolis = dynamics_.coriolis;
  in.K = K;
  in.nullspace_stiffness = nullspace;
  in.rotor_inertia = parameters_.rotor_inertia;
  return cartesianImpedance(in);
}

}  // namespace franka_sim
