// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/cartesian_impedance.h"

#include <franka_core/rotations.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "robot/laws/damping_factor.h"

namespace franka_sim {

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

}  // namespace franka_sim
