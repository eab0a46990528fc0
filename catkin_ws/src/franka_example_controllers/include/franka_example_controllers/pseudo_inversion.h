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
/// Without damping, singular values that are zero within rounding stay zero. Allocates: not for the
/// 1 kHz loop, where dampedPseudoInverse() gives the same result (decision 41).
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

/// Damped pseudo-inverse of a matrix of fixed size: M^T (M M^T + damping^2 I)^-1, or the equivalent
/// with the smaller matrix to solve. Real-time safe: no allocation.
template <int Rows, int Columns>
Eigen::Matrix<double, Columns, Rows> dampedPseudoInverse(
    const Eigen::Matrix<double, Rows, Columns>& matrix, double damping = kPseudoInverseDamping) {
  constexpr int kSmaller = Rows < Columns ? Rows : Columns;
  using Square = Eigen::Matrix<double, kSmaller, kSmaller>;
  if constexpr (Rows >= Columns) {
    const Square gram = matrix.transpose() * matrix + damping * damping * Square::Identity();
    return gram.ldlt().solve(matrix.transpose());
  } else {
    const Square gram = matrix * matrix.transpose() + damping * damping * Square::Identity();
    return gram.ldlt().solve(matrix).transpose();
  }
}

}  // namespace franka_example_controllers
