// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/control_laws.h"

#include <franka_core/finite.h>
#include <franka_core/rotations.h>
#include <franka_sim/robot/plant.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

namespace {

constexpr double kStep = 1000.0 * kTick;  // [Nm] per tick (protocol 5.5)

}  // namespace

std::array<double, 7> TorqueBlend::apply(const std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (changing_) {
      offset_[i] = last_[i] - tau[i];
    }
    offset_[i] -= std::clamp(offset_[i], -kStep, kStep);
    last_[i] = tau[i] + offset_[i];
  }
  changing_ = false;
  return last_;
}

void TorqueBlend::restart() noexcept {
  changing_ = false;
  offset_.fill(0.0);
  last_.fill(0.0);
}

std::array<double, 7> saturate(const std::array<double, 7>& tau,
                               const std::array<double, 7>& limit) noexcept {
  std::array<double, 7> result;
  for (std::size_t i = 0; i < 7; i++) {
    result[i] = std::isfinite(tau[i]) ? std::clamp(tau[i], -limit[i], limit[i]) : 0.0;
  }
  return result;
}

bool TorqueCommand::jumps(const std::array<double, 7>& tau) const noexcept {
  constexpr double kStep = (1000.0 + 0.01) * kTick;
  for (std::size_t i = 0; i < 7; i++) {
    const double step = std::min(std::abs(tau[i] - tau_[i]), std::abs(tau[i] - commanded_[i]));
    if (!(step <= kStep)) {
      return true;
    }
  }
  return false;
}

bool TorqueCommand::receive(const std::array<double, 7>& tau) noexcept {
  if (!franka_core::allFinite(tau)) {
    return false;
  }
  commanded_ = tau;
  tau_ = saturate(tau, limit_);
  return true;
}

std::array<double, 7> JointImpedance::torque(const std::array<double, 7>& q_d,
                                             const std::array<double, 7>& dq_d,
                                             const std::array<double, 7>& q,
                                             const std::array<double, 7>& dq,
                                             const std::array<double, 49>& mass,
                                             const std::array<double, 7>& coriolis) const noexcept {
  std::array<double, 7> tau;
  for (std::size_t i = 0; i < 7; i++) {
    const double inertia = mass[8 * i] + rotor_inertia_[i];
    const double damping = kDampingFactor * std::sqrt(stiffness_[i] * inertia);
    tau[i] = stiffness_[i] * (q_d[i] - q[i]) + damping * (dq_d[i] - dq[i]) + coriolis[i];
  }
  return tau;
}

namespace {

using Jacobian = Eigen::Matrix<double, 6, 7>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

// Keeps the null space projector smooth at singularities. Elsewhere (smallest singular value s
// above 0.1) less than 1e-4 of the soft null space spring leaks into the task.
constexpr double kProjectorDamping = 1e-6;

struct Task {
  Vector6 error;  // desired minus measured, axes of K
  Vector6 speed;  // the same of the twists
  Jacobian J;     // of K's origin, axes of K
};

Task taskOf(const CartesianImpedanceInput& in) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> EE(in.O_T_EE.data());
  const Eigen::Map<const Eigen::Matrix4d> EE_d(in.O_T_EE_d.data());
  const Eigen::Map<const Eigen::Matrix4d> K(in.EE_T_K.data());
  const Eigen::Map<const Jacobian> J_EE(in.O_J_EE.data());
  const Eigen::Map<const Vector6> twist_d(in.O_dP_EE_d.data());

  const Eigen::Matrix3d R = EE.topLeftCorner<3, 3>() * K.topLeftCorner<3, 3>();
  const Eigen::Matrix3d R_d = EE_d.topLeftCorner<3, 3>() * K.topLeftCorner<3, 3>();
  const Eigen::Vector3d r = EE.topLeftCorner<3, 3>() * K.topRightCorner<3, 1>();
  const Eigen::Vector3d r_d = EE_d.topLeftCorner<3, 3>() * K.topRightCorner<3, 1>();

  Task task;
  const Eigen::Vector3d away = EE_d.topRightCorner<3, 1>() + r_d - EE.topRightCorner<3, 1>() - r;
  task.error.head<3>() = R.transpose() * away;
  task.error.tail<3>() = franka_core::vectorOf(Eigen::Matrix3d(R.transpose() * R_d));

  for (int i = 0; i < 7; i++) {
    const Eigen::Vector3d w = J_EE.block<3, 1>(3, i);
    const Eigen::Vector3d v = J_EE.block<3, 1>(0, i);
    task.J.block<3, 1>(0, i) = R.transpose() * (v + w.cross(r));
    task.J.block<3, 1>(3, i) = R.transpose() * w;
  }
  const Eigen::Vector3d w_d = twist_d.tail<3>();
  task.speed.head<3>() = R.transpose() * (twist_d.head<3>() + w_d.cross(r_d));
  task.speed.tail<3>() = R.transpose() * w_d;
  task.speed.noalias() -= task.J.lazyProduct(Eigen::Map<const Vector7>(in.dq.data()));
  return task;
}

Vector7 nullSpaceTorque(const CartesianImpedanceInput& in, const Matrix7& M,
                        const Jacobian& J) noexcept {
  Vector7 spring;
  for (int i = 0; i < 7; i++) {
    const double damping = 2.0 * std::sqrt(in.nullspace_stiffness * M(i, i));
    spring[i] = in.nullspace_stiffness * (in.q_d[i] - in.q[i]) - damping * in.dq[i];
  }
  Matrix6 gram = J.lazyProduct(J.transpose());
  gram.diagonal().array() += kProjectorDamping;
  const Vector6 task_part = gram.llt().solve(Vector6(J.lazyProduct(spring)));
  return spring - J.transpose().lazyProduct(task_part);
}

}  // namespace

std::array<double, 7> cartesianImpedance(const CartesianImpedanceInput& in) noexcept {
  Matrix7 M = Eigen::Map<const Matrix7>(in.mass.data());
  M.diagonal() += Eigen::Map<const Vector7>(in.rotor_inertia.data());
  const Task task = taskOf(in);

  // (J M^-1 J^T)_ii is the squared norm of the column i of L^-1 J^T.
  const Eigen::LLT<Matrix7> llt(M);
  Eigen::Matrix<double, 7, 6> half = task.J.transpose();
  llt.matrixL().solveInPlace(half);

  Vector6 wrench;
  for (int i = 0; i < 6; i++) {
    const double mobility = half.col(i).squaredNorm();
    const double damping = mobility > 0.0 ? kDampingFactor * std::sqrt(in.K[i] / mobility) : 0.0;
    wrench[i] = in.K[i] * task.error[i] + damping * task.speed[i];
  }
  std::array<double, 7> tau;
  Eigen::Map<Vector7>(tau.data()) = task.J.transpose().lazyProduct(wrench) +
                                    nullSpaceTorque(in, M, task.J) +
                                    Eigen::Map<const Vector7>(in.coriolis.data());
  return tau;
}

using franka_core::ControllerMode;
using franka_core::RobotMode;

namespace {

// Stiffness of the axes and the elbow that are not free in Guiding. Chosen here: equal to the
// initial values of Cartesian impedance control, because the stiffness of a real robot is not
// published.
constexpr double kGuidingTranslation = 3000.0;  // [N/m]
constexpr double kGuidingRotation = 300.0;      // [Nm/rad]
constexpr double kGuidingNullspace = 200.0;     // [Nm/rad]
constexpr double kNullspace = 10.0;             // [Nm/rad], chosen here (decision 11)

/// Fills the fields that do not depend on the task.
CartesianImpedanceInput measuredInput(const ControlUnitParameters& parameters,
                                      const franka_core::RobotState& state,
                                      const Estimate& estimate) noexcept {
  CartesianImpedanceInput in;
  in.O_T_EE = state.O_T_EE;
  in.EE_T_K = state.EE_T_K;
  in.O_J_EE = estimate.dynamics.zero_jacobian;
  in.mass = estimate.dynamics.mass;
  in.q = state.q;
  in.dq = estimate.dq;
  in.coriolis = estimate.dynamics.coriolis;
  in.rotor_inertia = parameters.rotor_inertia;
  return in;
}

std::array<double, 7> guide(CartesianImpedanceInput in, const GuidingTask& guiding) noexcept {
  in.O_T_EE_d = guiding.O_T_EE;
  in.O_dP_EE_d.fill(0.0);
  in.q_d = guiding.q;
  for (std::size_t i = 0; i < 6; i++) {
    in.K[i] = guiding.free[i] ? 0.0 : (i < 3 ? kGuidingTranslation : kGuidingRotation);
  }
  in.nullspace_stiffness = guiding.elbow_free ? 0.0 : kGuidingNullspace;
  return cartesianImpedance(in);
}

// The torques that links and rotors need for a desired acceleration, here that of braking. They act
// without a blend: an arm that begins to brake too late overshoots and springs back.
std::array<double, 7> accelerating(const std::array<double, 7>& ddq_d,
                                   const std::array<double, 49>& mass,
                                   const std::array<double, 7>& rotor_inertia) noexcept {
  std::array<double, 7> tau;
  for (std::size_t i = 0; i < 7; i++) {
    tau[i] = rotor_inertia[i] * ddq_d[i];
    for (std::size_t j = 0; j < 7; j++) {
      tau[i] += mass[7 * j + i] * ddq_d[j];
    }
  }
  return tau;
}

std::array<double, 7> sumOf(std::array<double, 7> a, const std::array<double, 7>& b) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    a[i] += b[i];
  }
  return a;
}

std::array<double, 7> follow(CartesianImpedanceInput in, const franka_core::RobotState& state,
                             const std::array<double, 6>& stiffness) noexcept {
  in.O_T_EE_d = state.O_T_EE_d;
  in.O_dP_EE_d = state.O_dP_EE_d;
  in.q_d = state.q_d;
  in.K = stiffness;
  in.nullspace_stiffness = kNullspace;
  return cartesianImpedance(in);
}

}  // namespace

const std::array<double, 7>& ControlLaws::torques(const ControlTask& task,
                                                  const franka_core::RobotState& state,
                                                  const Estimate& estimate) noexcept {
  if (task.law_switch == LawSwitch::kBlend) {
    blend_.lawChanges();
  } else if (task.law_switch == LawSwitch::kFromZero) {
    blend_.lawStartsFromZero();
  }
  const ControlUnitParameters& parameters = configuration_->parameters();
  law_ = saturate(law(task, state, estimate), parameters.max_torque);
  motor_torques_ = blend_.apply(law_);
  if (task.mode != RobotMode::kMove && state.ddq_d != std::array<double, 7>{}) {
    const std::array<double, 7> braking =
        accelerating(state.ddq_d, estimate.dynamics.mass, parameters.rotor_inertia);
    motor_torques_ = sumOf(motor_torques_, braking);
  }
  motor_torques_ = saturate(motor_torques_, parameters.max_torque);
  // The configured payload may be heavier than a motor can hold.
  motor_torques_ =
      sumOf(motor_torques_, saturate(estimate.dynamics.gravity, parameters.max_torque));
  return motor_torques_;
}

const std::array<double, 7>& ControlLaws::rest() noexcept {
  blend_.restart();
  motor_torques_.fill(0.0);
  return motor_torques_;
}

std::array<double, 7> ControlLaws::law(const ControlTask& task,
                                       const franka_core::RobotState& state,
                                       const Estimate& estimate) const noexcept {
  const ControlUnitParameters& parameters = configuration_->parameters();
  const auto joint_impedance = [&](const std::array<double, 7>& stiffness) {
    return JointImpedance(stiffness, parameters.rotor_inertia)
        .torque(state.q_d, state.dq_d, state.q, estimate.dq, estimate.dynamics.mass,
                estimate.dynamics.coriolis);
  };
  if (task.mode == RobotMode::kGuiding) {
    return guide(measuredInput(parameters, state, estimate), task.guiding);
  }
  if (task.mode != RobotMode::kMove) {
    // Holds a pose that was latched at the start of the mode (decision 6), or brakes.
    return joint_impedance(parameters.joint_stiffness);
  }
  switch (task.controller) {
    case ControllerMode::kExternalController:
      return task.tau;
    case ControllerMode::kCartesianImpedance:
      return follow(measuredInput(parameters, state, estimate), state,
                    parameters.cartesian_stiffness);
    default:
      return joint_impedance(configuration_->jointStiffness());
  }
}

}  // namespace franka_sim
