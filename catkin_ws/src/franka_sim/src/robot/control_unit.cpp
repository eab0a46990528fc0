// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The first half of a tick: from a measurement to a state, and what is wrong with it.
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/deviation.h>
#include <franka_sim/robot/elbow.h>
#include <franka_sim/robot/link_accelerometers.h>
#include <franka_sim/robot/measured_limits.h>
#include <franka_sim/robot/parameter_checks.h>
#include <franka_sim/robot/tick.h>
#include <franka_sim/robot/transforms.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

using franka_core::ArmFrame;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

namespace {

constexpr double kJointElasticity = 14250.0;  // [Nm/rad] (decision 2)

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

std::array<double, 6> twist(const std::array<double, 42>& jacobian,
                            const std::array<double, 7>& dq) noexcept {
  std::array<double, 6> result;
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(result.data()) =
      Eigen::Map<const Eigen::Matrix<double, 6, 7>>(jacobian.data())
          .lazyProduct(Eigen::Map<const Eigen::Matrix<double, 7, 1>>(dq.data()));
  return result;
}

bool any(const std::array<double, 7>& values) noexcept {
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; });
}

bool any(const std::array<double, 6>& values) noexcept {
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; });
}

}  // namespace

ControlUnit::ControlUnit(const ControlUnitParameters& parameters)
    : parameters_(checked(parameters)),
      external_torque_(parameters.substeps),
      self_collision_(parameters.has_hand),
      generator_(motionLimitsOfProtocol(parameters.protocol_version)),
      torque_command_(parameters.max_torque),
      hold_(parameters.joint_stiffness, parameters.rotor_inertia),
      joint_controller_(parameters.joint_stiffness, parameters.rotor_inertia) {
  showConfiguration();
  showModes();
}

const franka_core::RobotState& ControlUnit::observe(const ArmMeasurement& measurement) noexcept {
  const bool good = isFinite(measurement);
  const bool measured = good && continuous_;
  const bool first = !started_;
  continuous_ = good;
  started_ = true;
  const ArmMeasurement now = good ? measurement : restingAt(state_.q);
  const std::array<double, 7> dq_before = measured ? state_.dq : now.dq;

  state_.message_id++;
  state_.q = now.q;
  state_.dq = now.dq;
  parameters_.model.computeDynamics(ArmFrame::kEndEffector, now.q, now.dq, state_.F_T_EE,
                                    state_.EE_T_K, total_, parameters_.gravity, dynamics_);
  state_.O_T_EE = dynamics_.pose;
  state_.elbow = elbowOf(now.q);
  O_dP_EE_ = twist(dynamics_.zero_jacobian, now.dq);
  if (first) {
    state_.tau_J = dynamics_.gravity;
    beginHere();
  } else if (mode() == RobotMode::kGuiding) {
    holdHere();
  }
  observeTorques(now, measured);
  observeContacts();
  observeAccelerometers(dq_before);
  observeDesired();
  if (parameters_.reflexes && measured) {
    checkMeasurement();
  }
  state_.control_command_success_rate = losses_.rate();
  return state_;
}

// What a mode remembers of the pose in which it began belongs to this pose now.
void ControlUnit::beginHere() noexcept {
  holdHere();
  guiding_pose_ = state_.O_T_EE;
  guiding_q_ = state_.q;
  if (mode() == RobotMode::kMove) {
    self_collision_.begin(parameters_.model, state_.q);
    walls_.begin(state_.O_T_EE);
  }
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
  if (measured) {
    tau_ext_ = external_torque_.update(parameters_.model, total_, parameters_.gravity, measurement);
  } else {
    tau_ext_.fill(0.0);
    external_torque_.restart(measurement);
  }
  state_.tau_ext_hat_filtered = tau_ext_filter_.update(tau_ext_);
}

void ControlUnit::observeContacts() noexcept {
  external_wrench_.update(dynamics_.pose, dynamics_.zero_jacobian, state_.EE_T_K);
  state_.O_F_ext_hat_K = external_wrench_.inBase(state_.tau_ext_hat_filtered);
  state_.K_F_ext_hat_K = external_wrench_.inStiffness(state_.O_F_ext_hat_K);

  in_acceleration_ = phase_.update(accelerating_);
  const bool in_K = parameters_.threshold_frame == ThresholdFrame::kStiffness;
  if (!parameters_.reflexes) {
    // Without reflexes: the manual's formulas, applied to the published values (decision 48).
    const std::array<double, 6>& shown = in_K ? state_.K_F_ext_hat_K : state_.O_F_ext_hat_K;
    state_.joint_contact = above(state_.tau_ext_hat_filtered, thresholds().lower_torque);
    state_.joint_collision = above(state_.tau_ext_hat_filtered, thresholds().upper_torque);
    state_.cartesian_contact = above(shown, thresholds().lower_force);
    state_.cartesian_collision = above(shown, thresholds().upper_force);
    return;
  }
  // The robot's reflexes use the unfiltered values, which have no delay.
  wrench_ = external_wrench_.inBase(tau_ext_);
  if (in_K) {
    wrench_ = external_wrench_.inStiffness(wrench_);
  }
  joint_contacts_.update(tau_ext_, thresholds().lower_torque, thresholds().upper_torque);
  cartesian_contacts_.update(wrench_, thresholds().lower_force, thresholds().upper_force);
  state_.joint_contact = joint_contacts_.contact();
  state_.joint_collision = joint_contacts_.collision();
  state_.cartesian_contact = cartesian_contacts_.contact();
  state_.cartesian_collision = cartesian_contacts_.collision();
}

void ControlUnit::observeAccelerometers(const std::array<double, 7>& dq_before) noexcept {
  std::array<double, 7> ddq;
  for (std::size_t i = 0; i < 7; i++) {
    ddq[i] = (state_.dq[i] - dq_before[i]) / kTick;
  }
  const LinkAccelerations readings =
      linkAccelerations(parameters_.model, state_.q, state_.dq, ddq, parameters_.gravity);
  state_.accelerometer_top = readings.top;
  state_.accelerometer_bottom = readings.bottom;
}

// While no generator shows them: at rest or braking.
void ControlUnit::observeDesired() noexcept {
  if (!desired_stale_) {
    return;
  }
  desired_stale_ = false;
  state_.O_T_EE_d =
      parameters_.model.pose(ArmFrame::kEndEffector, state_.q_d, state_.F_T_EE, state_.EE_T_K);
  state_.O_T_EE_c = state_.O_T_EE_d;
  state_.O_dP_EE_d.fill(0.0);
  if (any(state_.dq_d)) {
    state_.O_dP_EE_d = twist(parameters_.model.zeroJacobian(ArmFrame::kEndEffector, state_.q_d,
                                                            state_.F_T_EE, state_.EE_T_K),
                             state_.dq_d);
  }
  state_.O_dP_EE_c = state_.O_dP_EE_d;
  state_.O_ddP_EE_c.fill(0.0);
  state_.elbow_d = elbowOf(state_.q_d);
  state_.elbow_c = state_.elbow_d;
  state_.delbow_c = {{state_.dq_d[2], 0.0}};
  state_.ddelbow_c = {{state_.ddq_d[2], 0.0}};
}

// --- what is wrong -------------------------------------------------------------------------------

void ControlUnit::checkMeasurement() noexcept {
  if (mode() != RobotMode::kIdle && mode() != RobotMode::kMove) {
    return;
  }
  const std::optional<ErrorFlag> violation =
      measuredViolation(generator_.limits().arm, state_, O_dP_EE_);
  if (violation) {
    flag(indexOf(*violation));
  }
  checkContacts();
  if (mode() == RobotMode::kMove) {
    checkMotion();
  }
  react();
}

void ControlUnit::checkContacts() noexcept {
  if (any(state_.joint_collision)) {
    joint_collision_ = worstOf(tau_ext_, thresholds().upper_torque);
    flag(indexOf(ErrorFlag::kJointReflex));
  }
  if (any(state_.cartesian_collision)) {
    cartesian_collision_ = worstOf(wrench_, thresholds().upper_force);
    flag(indexOf(ErrorFlag::kCartesianReflex));
  }
}

void ControlUnit::checkMotion() noexcept {
  // Torques from outside bring the arm wherever they like, whatever a generator beside them wants.
  const bool generated = generates() && !controlledOutside();
  if (self_collision_.violated(parameters_.model, generated ? state_.q_d : state_.q)) {
    flag(indexOf(ErrorFlag::kSelfCollision));
  }
  if (walls_.violated(state_.O_T_EE)) {
    flag(indexOf(ErrorFlag::kVirtualWall));
  }
  if (controlledOutside()) {
    const std::optional<ErrorFlag> fault =
        force_watch_.update(tau_ext_, state_.tau_J, motor_torque_, parameters_.max_torque);
    if (fault) {
      flag(indexOf(*fault));
    }
    return;
  }
  if (deviates(state_, move_.max_path_deviation)) {
    flag(indexOf(ErrorFlag::kPathDeviation));
  }
  const bool cartesian = move_.motion_generator_mode == MotionGeneratorMode::kCartesianPosition ||
                         move_.motion_generator_mode == MotionGeneratorMode::kCartesianVelocity;
  // No rule is published; ours: the hand moves against its profile, by more than the speed limit.
  const double difference =
      std::hypot(O_dP_EE_[0] - state_.O_dP_EE_d[0], O_dP_EE_[1] - state_.O_dP_EE_d[1],
                 O_dP_EE_[2] - state_.O_dP_EE_d[2]);
  if (cartesian && difference > generator_.limits().arm.translation.velocity) {
    flag(indexOf(ErrorFlag::kVelocityProfile));
  }
}

}  // namespace franka_sim
