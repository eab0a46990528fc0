// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace franka_sim {

namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using Joints = std::array<double, 7>;
using Jacobian = Eigen::Matrix<double, 6, 7>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

// Chosen from measured convergence (decision 12).
constexpr double kSingularStart = 0.01;
constexpr double kNearlySingular = 0.02;
constexpr double kMaxDamping = 0.02;
constexpr int kMaxIterations = 8;
constexpr double kTolerance = 1e-13;  // larger residuals become jerk

Matrix7 withElbowRow(const std::array<double, 42>& jacobian) noexcept {
  Matrix7 matrix = Matrix7::Zero();
  matrix.topRows<6>() = Eigen::Map<const Jacobian>(jacobian.data());
  matrix(6, 2) = 1.0;
  return matrix;
}

// A symmetric matrix minus s^2 I is positive definite if and only if its eigenvalues exceed s^2;
// this test is cheaper than the eigenvalues.
bool hasSingularValueBelow(const Matrix7& gram, double bound) noexcept {
  Matrix7 shifted = gram;
  shifted.diagonal().array() -= bound * bound;
  return shifted.llt().info() != Eigen::Success;
}

double smallestSingularValue(const Matrix7& gram) noexcept {
  const Eigen::SelfAdjointEigenSolver<Matrix7> solver(gram, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues()(0), 0.0));
}

Vector7 residual(const Transform& desired, double q3_desired, const Transform& reached,
                 double q3) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> to(desired.data());
  const Eigen::Map<const Eigen::Matrix4d> from(reached.data());
  const Eigen::Matrix3d turn = to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose();
  Vector7 error;
  error.head<3>() = to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>();
  error.segment<3>(3) << turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1);
  error.segment<3>(3) *= 0.5;
  error(6) = q3_desired - q3;
  return error;
}

void add(const Vector7& step, Joints& q) noexcept { Eigen::Map<Vector7>(q.data()) += step; }

void reach(const Transform& F_T_EE, const ArmModel& model,
           InverseKinematics::Solution& solution) noexcept {
  solution.O_T_EE = model.pose(ArmFrame::kEndEffector, solution.q, F_T_EE);
  solution.jacobian = model.zeroJacobian(ArmFrame::kEndEffector, solution.q, F_T_EE);
}

// One step of damped least squares: J^T (J J^T + damping I)^-1 error. The damping grows from zero
// at the bound to kMaxDamping^2 at a singularity (Chiaverini, 1997).
Vector7 dampedStep(const Matrix7& matrix, const Matrix7& gram, const Vector7& error) noexcept {
  const double share = smallestSingularValue(gram) / kNearlySingular;
  const double damping = (1.0 - share * share) * kMaxDamping * kMaxDamping;
  Matrix7 damped = gram;
  damped.diagonal().array() += damping;
  return matrix.transpose() * damped.llt().solve(error);
}

}  // namespace

bool InverseKinematics::isSingular(const Joints& q, const Transform& F_T_EE,
                                   const ArmModel& model) noexcept {
  const Matrix7 matrix = withElbowRow(model.zeroJacobian(ArmFrame::kEndEffector, q, F_T_EE));
  return hasSingularValueBelow(matrix.lazyProduct(matrix.transpose()), kSingularStart);
}

InverseKinematics::Solution InverseKinematics::solve(const Joints& q_last, const Transform& O_T_EE,
                                                     double q3, const Transform& F_T_EE,
                                                     const ArmModel& model) noexcept {
  Solution solution;
  solution.q = q_last;
  reach(F_T_EE, model, solution);
  Vector7 error = residual(O_T_EE, q3, solution.O_T_EE, solution.q[2]);
  Matrix7 matrix = withElbowRow(solution.jacobian);
  const Matrix7 gram = matrix.lazyProduct(matrix.transpose());
  if (hasSingularValueBelow(gram, kNearlySingular)) {
    solution.near_singularity = true;
    add(dampedStep(matrix, gram, error), solution.q);
    reach(F_T_EE, model, solution);
    return solution;
  }
  for (int i = 0; i < kMaxIterations && error.cwiseAbs().maxCoeff() >= kTolerance; i++) {
    add(matrix.partialPivLu().solve(error), solution.q);
    reach(F_T_EE, model, solution);
    error = residual(O_T_EE, q3, solution.O_T_EE, solution.q[2]);
    matrix = withElbowRow(solution.jacobian);
  }
  return solution;
}

}  // namespace franka_sim
