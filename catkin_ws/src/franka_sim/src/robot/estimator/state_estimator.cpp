// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/estimator/state_estimator.h"

#include <franka_core/finite.h>

#include <cstddef>
#include <numeric>

#include "robot/estimator/link_accelerations.h"
#include "robot/transforms.h"

namespace franka_sim {

using franka_core::ArmFrame;

namespace {

constexpr double kJointElasticity = 14250.0;  // [Nm/rad] (decision 2)

bool isFinite(const ArmMeasurement& m) noexcept {
  return franka_core::allFinite(m.q) && franka_core::allFinite(m.dq) &&
         franka_core::allFinite(m.tau_J);
}

double mean(const std::array<double, 7>& values) noexcept {
  return std::accumulate(values.begin(), values.end(), 0.0) / 7.0;
}

ArmMeasurement restingAt(const std::array<double, 7>& q) noexcept {
  ArmMeasurement measurement;
  measurement.q = q;
  return measurement;
}

}  // namespace

StateEstimator::StateEstimator(const Configuration& configuration,
                               franka_core::RobotState& state) noexcept
    : configuration_(&configuration),
      state_(&state),
      noise_(configuration.parameters().sensors),
      tau_ext_filter_(configuration.parameters().sensors.tau_ext_cutoff),
      wrench_filter_(mean(configuration.parameters().sensors.tau_ext_cutoff)) {}

void StateEstimator::update(const ArmMeasurement& measurement,
                            const CollisionThresholds& thresholds) noexcept {
  const bool good = isFinite(measurement);
  estimate_.first = !started_;
  estimate_.measured = good && continuous_;
  started_ = true;
  continuous_ = good;
  const ArmMeasurement now = good ? measurement : restingAt(state_->q);
  const std::array<double, 7> dq_before = estimate_.measured ? estimate_.dq : now.dq;

  const ControlUnitParameters& parameters = configuration_->parameters();
  state_->message_id++;
  state_->q = now.q;
  estimate_.dq = now.dq;
  state_->dq = noise_.velocities(now.dq);
  parameters.model.computeDynamics(ArmFrame::kEndEffector, now.q, now.dq, state_->F_T_EE,
                                   state_->EE_T_K, configuration_->payload(), parameters.gravity,
                                   estimate_.dynamics);
  state_->O_T_EE = estimate_.dynamics.pose;
  state_->elbow = elbowOf(now.q);
  estimate_.O_dP_EE = twist(estimate_.dynamics.zero_jacobian, now.dq);
  if (estimate_.first) {
    state_->tau_J = estimate_.dynamics.gravity;
  }
  updateTorques(now);
  updateContacts(thresholds);
  updateAccelerometers(dq_before);
}

void StateEstimator::updateTorques(const ArmMeasurement& measurement) noexcept {
  estimate_.tau_J = estimate_.measured ? measurement.tau_J : estimate_.dynamics.gravity;
  const std::array<double, 7> tau_J = noise_.torques(estimate_.tau_J, estimate_.dq);
  std::array<double, 7> difference;
  for (std::size_t i = 0; i < 7; i++) {
    difference[i] = (tau_J[i] - state_->tau_J[i]) / kTick;
  }
  state_->tau_J = tau_J;
  state_->dtau_J = dtau_J_filter_.update(difference);
  for (std::size_t i = 0; i < 7; i++) {
    state_->theta[i] = state_->q[i] + state_->tau_J[i] / kJointElasticity;
    state_->dtheta[i] = state_->dq[i] + state_->dtau_J[i] / kJointElasticity;
  }
  if (estimate_.measured) {
    const ControlUnitParameters& parameters = configuration_->parameters();
    estimate_.tau_ext = external_torque_.update(
        parameters.model, configuration_->payload(), parameters.gravity,
        {measurement.q, measurement.dq, tau_J, measurement.substeps}, estimate_.dynamics);
  } else {
    estimate_.tau_ext.fill(0.0);
    external_torque_.restart(configuration_->payload(), measurement, estimate_.dynamics);
  }
  state_->tau_ext_hat_filtered = tau_ext_filter_.update(estimate_.tau_ext);
}

void StateEstimator::updateContacts(const CollisionThresholds& thresholds) noexcept {
  external_wrench_.update(estimate_.dynamics.pose, estimate_.dynamics.zero_jacobian,
                          state_->EE_T_K);
  state_->O_F_ext_hat_K = external_wrench_.inBase(wrench_filter_.update(estimate_.tau_ext));
  state_->K_F_ext_hat_K = external_wrench_.inStiffness(state_->O_F_ext_hat_K);

  const bool in_base = checksWrenchInBase(configuration_->parameters().rules);
  if (!configuration_->hasReflexes()) {
    // Without reflexes: the manual's formulas, applied to the published values (decision 48).
    const std::array<double, 6>& published =
        in_base ? state_->O_F_ext_hat_K : state_->K_F_ext_hat_K;
    state_->joint_contact = above(state_->tau_ext_hat_filtered, thresholds.lower_torque);
    state_->joint_collision = above(state_->tau_ext_hat_filtered, thresholds.upper_torque);
    state_->cartesian_contact = above(published, thresholds.lower_force);
    state_->cartesian_collision = above(published, thresholds.upper_force);
    return;
  }
  // The robot's reflexes use the unfiltered values, which have no delay.
  estimate_.wrench = external_wrench_.inBase(estimate_.tau_ext);
  if (!in_base) {
    estimate_.wrench = external_wrench_.inStiffness(estimate_.wrench);
  }
  joint_contacts_.update(estimate_.tau_ext, thresholds.lower_torque, thresholds.upper_torque);
  cartesian_contacts_.update(estimate_.wrench, thresholds.lower_force, thresholds.upper_force);
  state_->joint_contact = joint_contacts_.contact();
  state_->joint_collision = joint_contacts_.collision();
  state_->cartesian_contact = cartesian_contacts_.contact();
  state_->cartesian_collision = cartesian_contacts_.collision();
}

void StateEstimator::updateAccelerometers(const std::array<double, 7>& dq_before) noexcept {
  std::array<double, 7> ddq;
  for (std::size_t i = 0; i < 7; i++) {
    ddq[i] = (estimate_.dq[i] - dq_before[i]) / kTick;
  }
  const ControlUnitParameters& parameters = configuration_->parameters();
  const LinkAccelerations readings =
      linkAccelerations(parameters.model, state_->q, estimate_.dq, ddq, parameters.gravity);
  state_->accelerometer_top = readings.top;
  state_->accelerometer_bottom = readings.bottom;
}

void StateEstimator::clearContacts() noexcept {
  joint_contacts_.clear();
  cartesian_contacts_.clear();
  state_->joint_collision.fill(0.0);
  state_->cartesian_collision.fill(0.0);
}

void StateEstimator::restart() noexcept {
  started_ = false;
  continuous_ = false;
  noise_.restart();
  tau_ext_filter_.restart();
  wrench_filter_.restart();
  dtau_J_filter_.restart();
  joint_contacts_.clear();
  cartesian_contacts_.clear();
}

}  // namespace franka_sim
