// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SVD>

namespace franka_example_controllers {

/// Damping of inverses near singularities; the original's constant.
constexpr double kPseudoInverseDamping = 0.2;

/// Pseudo-inverse of any matrix by singular values, each inverted to s / (s^2 + damping^2).
///
/// Without damping, singular values that are zero within rounding stay zero. Not real-time safe.
/// dampedSolution() gives the same result in the control loop (decision 41).
inline void pseudoInverse(const Eigen::MatrixXd& matrix, Eigen::MatrixXd& inverse,
                          bool damped = true) {
  const double damping = damped ? kPseudoInverseDamping : 0.0;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& values = svd.singularValues();
  Eigen::VectorXd inverted = Eigen::VectorXd::Zero(values.size());
  for (Eigen::Index i = 0; i < (damped ? values.size() : svd.rank()); ++i) {
    inverted[i] = values[i] / (values[i] * values[i] + damping * damping);
  }
  inverse = svd.matrixV() * inverted.asDiagonal() * svd.matrixU().transpose();
}

/// Damped least squares: the damped pseudo-inverse of a matrix times a vector, (M^T M + damping^2
/// I)^-1 M^T v, for at least as many rows as columns. Real-time safe.
template <int Rows, int Columns>
Eigen::Matrix<double, Columns, 1> dampedSolution(const Eigen::Matrix<double, Rows, Columns>& matrix,
                                                 const Eigen::Matrix<double, Rows, 1>& vector,
                                                 double damping = kPseudoInverseDamping) {
  static_assert(Rows >= Columns, "the smaller square matrix is the one to solve");
  using Square = Eigen::Matrix<double, Columns, Columns>;
  const Square gram =
      matrix.transpose().lazyProduct(matrix) + damping * damping * Square::Identity();
  return gram.ldlt().solve(matrix.transpose() * vector);
}

}  // namespace franka_example_controllers
