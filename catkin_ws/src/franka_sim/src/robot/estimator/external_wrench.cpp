// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/estimator/external_wrench.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace franka_sim {

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

}  // namespace franka_sim
