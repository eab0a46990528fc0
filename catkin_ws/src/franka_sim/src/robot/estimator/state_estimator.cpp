// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/estimator/state_estimator.h"

#include <franka_core/finite.h>
#include <franka_sim/robot/plant.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <numeric>

#include "robot/transforms.h"

namespace franka_sim {

namespace {

bool same(const franka_core::Payload& one, const franka_core::Payload& other) noexcept {
  return one.mass == other.mass && one.com == other.com && one.inertia == other.inertia;
}

}  // namespace

// M(q) a + c(q, dq) + g(q) at the last sample.
std::array<double, 7> ExternalTorque::atStart(const std::array<double, 7>& ddq) const noexcept {
  std::array<double, 7> torque = constant_;
  for (std::size_t column = 0; column < 7; column++) {
    for (std::size_t row = 0; row < 7; row++) {
      torque[row] += mass_[7 * column + row] * ddq[column];
    }
  }
  return torque;
}

std::array<double, 7> ExternalTorque::update(const franka_core::ArmModel& model,
                                             const franka_core::Payload& payload,
                                             const std::array<double, 3>& gravity_earth,
                                             const ArmMeasurement& now,
                                             const franka_core::ArmDynamics& dynamics) noexcept {
  std::array<double, 7> tau_ext{};
  if (has_previous_) {
    const double alpha = (now.substeps - 1.0) / (2.0 * now.substeps);
    std::array<double, 7> q;
    std::array<double, 7> dq;
    std::array<double, 7> ddq;
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = q_[i] + alpha * (now.q[i] - q_[i]);
      dq[i] = dq_[i] + alpha * (now.dq[i] - dq_[i]);
      ddq[i] = (now.dq[i] - dq_[i]) / kTick;
    }
    const std::array<double, 7> explained =
        now.substeps == 1 && same(payload, payload_)
            ? atStart(ddq)
            : model.inverseDynamics(q, dq, ddq, payload, gravity_earth);
    for (std::size_t i = 0; i < 7; i++) {
      tau_ext[i] = now.tau_J[i] - explained[i];
    }
  }
  restart(payload, now, dynamics);
  return tau_ext;
}

void ExternalTorque::restart(const franka_core::Payload& payload, const ArmMeasurement& now,
                             const franka_core::ArmDynamics& dynamics) noexcept {
  q_ = now.q;
  dq_ = now.dq;
  payload_ = payload;
  mass_ = dynamics.mass;
  for (std::size_t i = 0; i < 7; i++) {
    constant_[i] = dynamics.coriolis[i] + dynamics.gravity[i];
  }
  has_previous_ = true;
}

namespace {

using Jacobian = Eigen::Matrix<double, 6, 7>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

constexpr double kMinSingularValue = 0.02;  // (decision 5)

// A symmetric matrix minus s^2 I is positive definite if and only if its eigenvalues exceed s^2.
bool isSingular(const Matrix6& gram) noexcept {
  Matrix6 shifted = gram;
  shifted.diagonal().array() -= kMinSingularValue * kMinSingularValue;
  return shifted.llt().info() != Eigen::Success;
}

}  // namespace

void ExternalWrench::update(const Transform& O_T_EE, const std::array<double, 42>& J_EE,
                            const Transform& EE_T_K) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> EE(O_T_EE.data());
  const Eigen::Map<const Eigen::Matrix4d> K(EE_T_K.data());
  const Eigen::Matrix3d O_R_EE = EE.topLeftCorner<3, 3>();
  Eigen::Map<Eigen::Matrix3d>(O_R_K_.data()).noalias() = O_R_EE * K.topLeftCorner<3, 3>();

  // The origin of K moves with the end effector: v_K = v_EE + w x r.
  jacobian_ = J_EE;
  Eigen::Map<Jacobian> jacobian(jacobian_.data());
  const Eigen::Vector3d r = O_R_EE * K.topRightCorner<3, 1>();
  for (int i = 0; i < 7; i++) {
    const Eigen::Vector3d w = jacobian.block<3, 1>(3, i);
    jacobian.block<3, 1>(0, i) += w.cross(r);
  }

  const Matrix6 gram = jacobian.lazyProduct(jacobian.transpose());
  singular_ = isSingular(gram);
  if (!singular_) {
    Eigen::Map<Matrix6>(factor_.data()) = gram.llt().matrixLLT();
  }
}

std::array<double, 6> ExternalWrench::inBase(const std::array<double, 7>& tau) const noexcept {
  std::array<double, 6> wrench{};
  if (!singular_) {
    const Eigen::Map<const Matrix6> factor(factor_.data());
    Eigen::Map<Vector6> F(wrench.data());
    F = Eigen::Map<const Jacobian>(jacobian_.data())
            .lazyProduct(Eigen::Map<const Vector7>(tau.data()));
    factor.triangularView<Eigen::Lower>().solveInPlace(F);
    factor.transpose().triangularView<Eigen::Upper>().solveInPlace(F);
  }
  return wrench;
}

std::array<double, 6> ExternalWrench::inStiffness(const std::array<double, 6>& O_F) const noexcept {
  const Eigen::Map<const Eigen::Matrix3d> O_R_K(O_R_K_.data());
  const Eigen::Map<const Vector6> F(O_F.data());
  std::array<double, 6> wrench;
  Eigen::Map<Vector6> K_F(wrench.data());
  K_F.head<3>().noalias() = O_R_K.transpose() * F.head<3>();
  K_F.tail<3>().noalias() = O_R_K.transpose() * F.tail<3>();
  return wrench;
}

// Recursion from base to flange, in the axes of the present link.
LinkAccelerations linkAccelerations(const franka_core::ArmModel& model,
                                    const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                    const std::array<double, 7>& ddq,
                                    const std::array<double, 3>& gravity_earth) noexcept {
  using Eigen::Vector3d;
  LinkAccelerations readings;
  const Vector3d z = Vector3d::UnitZ();
  Vector3d w = Vector3d::Zero();
  Vector3d dw = Vector3d::Zero();
  Vector3d a = -Vector3d(gravity_earth.data());
  for (std::size_t i = 0; i < 6; i++) {
    const Eigen::Map<const Eigen::Matrix4d> origin(model.links()[i].origin.data());
    const Vector3d p = origin.topRightCorner<3, 1>();
    a += dw.cross(p) + w.cross(w.cross(p));
    Eigen::Map<Vector3d>(readings.bottom[i].data()) = a;

    const Eigen::Matrix3d R =
        origin.topLeftCorner<3, 3>() * Eigen::AngleAxisd(q[i], z).toRotationMatrix();
    a = (R.transpose() * a).eval();
    w = (R.transpose() * w).eval();
    dw = (R.transpose() * dw + ddq[i] * z + w.cross(dq[i] * z)).eval();
    w += dq[i] * z;
    Eigen::Map<Vector3d>(readings.top[i].data()) = a;
  }
  return readings;
}

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
    const std::array<double, 6>& shown = in_base ? state_->O_F_ext_hat_K : state_->K_F_ext_hat_K;
    state_->joint_contact = above(state_->tau_ext_hat_filtered, thresholds.lower_torque);
    state_->joint_collision = above(state_->tau_ext_hat_filtered, thresholds.upper_torque);
    state_->cartesian_contact = above(shown, thresholds.lower_force);
    state_->cartesian_collision = above(shown, thresholds.upper_force);
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
