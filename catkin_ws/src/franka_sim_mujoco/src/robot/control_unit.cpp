// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/robot/control_unit.h>
#include <franka_sim_mujoco/robot/friction.h>
#include <franka_sim_mujoco/robot/parameter_checks.h>
#include <franka_sim_mujoco/robot/tick.h>
#include <franka_sim_mujoco/robot/transforms.h>

#include <cmath>
#include <cstddef>

namespace franka_sim_mujoco {

using franka_core::ArmFrame;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

namespace {

constexpr double kJointElasticity = 14250.0;       // [Nm/rad], decision 2
constexpr double kElbowFlip = -0.467002423653011;  // [rad], fci.md 5.5

const ControlUnitParameters& checked(const ControlUnitParameters& parameters) {
  checkParameters(parameters);
  return parameters;
}

bool isFinite(const ArmMeasurement& m) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (!std::isfinite(m.q[i]) || !std::isfinite(m.dq[i]) || !std::isfinite(m.tau_J[i])) {
      return false;
    }
  }
  return true;
}

ArmMeasurement restingAt(const std::array<double, 7>& q) noexcept {
  ArmMeasurement measurement;
  measurement.q = q;
  return measurement;
}

std::array<double, 2> elbowOf(const std::array<double, 7>& q) noexcept {
  return {{q[2], q[3] >= kElbowFlip ? 1.0 : -1.0}};
}

}  // namespace

ControlUnit::ControlUnit(const ControlUnitParameters& parameters)
    : parameters_(checked(parameters)),
      external_torque_(parameters.substeps),
      hold_(parameters.joint_stiffness, parameters.rotor_inertia),
      torque_command_(parameters.max_torque) {
  showConfiguration();
  showModes();
}

// --- observe: measurement -> state ---------------------------------------------------------------

const franka_core::RobotState& ControlUnit::observe(const ArmMeasurement& measurement) noexcept {
  const bool good = isFinite(measurement);
  const bool measured = good && continuous_;
  const bool first = !started_;
  continuous_ = good;
  started_ = true;
  const ArmMeasurement now = good ? measurement : restingAt(state_.q);

  state_.message_id++;
  state_.q = now.q;
  state_.dq = now.dq;
  parameters_.model.computeDynamics(ArmFrame::kEndEffector, now.q, now.dq, state_.F_T_EE,
                                    state_.EE_T_K, total_, parameters_.gravity, dynamics_);
  state_.O_T_EE = dynamics_.pose;
  state_.elbow = elbowOf(now.q);
  if (first) {
    state_.tau_J = dynamics_.gravity;
    holdHere();
  }
  observeTorques(now, measured);
  observeDesired();
  state_.control_command_success_rate = command_window_.rate();
  return state_;
}

void ControlUnit::observeTorques(const ArmMeasurement& measurement, bool measured) noexcept {
  const std::array<double, 7>& tau_J = measured ? measurement.tau_J : dynamics_.gravity;
  std::array<double, 7> difference;
  for (std::size_t i = 0; i < 7; i++) {
    difference[i] = (tau_J[i] - state_.tau_J[i]) / kTick;
  }
  state_.tau_J = tau_J;
  state_.dtau_J = dtau_J_filter_.update(difference);
  for (std::size_t i = 0; i < 7; i++) {
    state_.theta[i] = state_.q[i] + state_.tau_J[i] / kJointElasticity;
    state_.dtheta[i] = state_.dq[i] + state_.dtau_J[i] / kJointElasticity;
  }
  state_.tau_J_d = torque_command_.value();

  std::array<double, 7> tau_ext{};
  if (measured) {
    tau_ext = external_torque_.update(parameters_.model, total_, parameters_.gravity, measurement);
  } else {
    external_torque_.restart(measurement);
  }
  state_.tau_ext_hat_filtered = tau_ext_filter_.update(tau_ext);
  observeContacts(tau_ext);
}

void ControlUnit::observeContacts(const std::array<double, 7>& tau_ext) noexcept {
  external_wrench_.update(dynamics_.pose, dynamics_.zero_jacobian, state_.EE_T_K);
  state_.O_F_ext_hat_K = external_wrench_.inBase(state_.tau_ext_hat_filtered);
  state_.K_F_ext_hat_K = external_wrench_.inStiffness(state_.O_F_ext_hat_K);

  // Thresholds act on what the filters have not yet delayed (decision 3).
  std::array<double, 6> wrench = external_wrench_.inBase(tau_ext);
  if (parameters_.threshold_frame == ThresholdFrame::kStiffness) {
    wrench = external_wrench_.inStiffness(wrench);
  }
  const CollisionThresholds& thresholds = parameters_.nominal;
  joint_contacts_.update(tau_ext, thresholds.lower_torque, thresholds.upper_torque);
  cartesian_contacts_.update(wrench, thresholds.lower_force, thresholds.upper_force);
  state_.joint_contact = joint_contacts_.contact();
  state_.joint_collision = joint_contacts_.collision();
  state_.cartesian_contact = cartesian_contacts_.contact();
  state_.cartesian_collision = cartesian_contacts_.collision();
}

void ControlUnit::observeDesired() noexcept {
  if (!desired_stale_) {
    return;
  }
  desired_stale_ = false;
  state_.O_T_EE_d =
      parameters_.model.pose(ArmFrame::kEndEffector, state_.q_d, state_.F_T_EE, state_.EE_T_K);
  state_.O_T_EE_c = state_.O_T_EE_d;
  state_.elbow_d = elbowOf(state_.q_d);
  state_.elbow_c = state_.elbow_d;
}

// --- actuate: command -> torques -----------------------------------------------------------------

const std::array<double, 7>& ControlUnit::actuate(
    const franka_core::RobotCommand* command) noexcept {
  std::array<double, 7> tau{};
  if (takeCommand(command)) {
    tau = torque_command_.value();
  } else if (modes_.mode() == RobotMode::kIdle) {
    tau = saturate(hold_.torque(state_.q_d, state_.dq_d, state_.q, state_.dq, dynamics_.mass,
                                dynamics_.coriolis),
                   parameters_.max_torque);
  }
  if (brakesClosed() || !started_) {
    motor_torque_.fill(0.0);
    return motor_torque_;
  }
  const std::array<double, 7> friction =
      frictionCompensation(parameters_.coulomb_friction, parameters_.viscous_friction, state_.dq);
  for (std::size_t i = 0; i < 7; i++) {
    motor_torque_[i] = tau[i] + dynamics_.gravity[i] + friction[i];
  }
  return motor_torque_;
}

bool ControlUnit::takeCommand(const franka_core::RobotCommand* command) noexcept {
  if (modes_.mode() != RobotMode::kMove) {
    return false;
  }
  const bool received = command != nullptr && torque_command_.receive(command->tau_J_d);
  command_window_.record(received);
  if (received && command->torque_command_finished) {
    stopMotion();
    return false;
  }
  return true;
}

// --- requests ------------------------------------------------------------------------------------

RequestStatus ControlUnit::startTorqueControl() noexcept {
  if (!started_ || !handle(ModeEvent::kMotionStarted)) {
    return RequestStatus::kNotPossible;
  }
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::stopMotion() noexcept {
  return handle(ModeEvent::kMotionEnded) ? RequestStatus::kSuccess : RequestStatus::kNotPossible;
}

void ControlUnit::setUserStop(bool pressed) noexcept {
  handle(pressed ? ModeEvent::kUserStopPressed : ModeEvent::kUserStopReleased);
}

RequestStatus ControlUnit::automaticErrorRecovery() noexcept {
  if (modes_.mode() == RobotMode::kUserStopped) {
    return RequestStatus::kNotPossible;
  }
  state_.errors.fill(false);
  joint_contacts_.clear();
  cartesian_contacts_.clear();
  return RequestStatus::kSuccess;
}

RequestStatus ControlUnit::setEE(const std::array<double, 16>& NE_T_EE) noexcept {
  if (!settersAllowed()) {
    return RequestStatus::kNotPossible;
  }
  if (!isTransform(NE_T_EE)) {
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
  if (!isTransform(EE_T_K)) {
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

void ControlUnit::restart() noexcept {
  started_ = false;
  continuous_ = false;
  tau_ext_filter_.restart();
  dtau_J_filter_.restart();
  joint_contacts_.clear();
  cartesian_contacts_.clear();
  torque_command_.clear();
}

// --- what requests change ------------------------------------------------------------------------

bool ControlUnit::settersAllowed() const noexcept {
  return parameters_.setters_in_motion || modes_.mode() != RobotMode::kMove;
}

bool ControlUnit::handle(ModeEvent event) noexcept {
  if (!modes_.handle(event)) {
    return false;
  }
  // Every transition starts at rest from the measured pose; no torque survives it.
  torque_command_.clear();
  command_window_.clear();
  holdHere();
  showModes();
  return true;
}

void ControlUnit::holdHere() noexcept {
  state_.q_d = state_.q;
  state_.dq_d.fill(0.0);
  state_.ddq_d.fill(0.0);
  desired_stale_ = true;
}

void ControlUnit::showModes() noexcept {
  const bool moving = modes_.mode() == RobotMode::kMove;
  state_.robot_mode = modes_.mode();
  state_.motion_generator_mode = moving ? MotionGeneratorMode::kNone : MotionGeneratorMode::kIdle;
  state_.controller_mode = moving ? ControllerMode::kExternalController : ControllerMode::kOther;
  state_.control_command_success_rate = command_window_.rate();
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

}  // namespace franka_sim_mujoco
