// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/robot/transforms.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace franka_sim_mujoco {

namespace {

constexpr double kTolerance = 1e-5;

bool isRotation(const Eigen::Matrix3d& rotation) noexcept {
  // Lengths, not their squares: four-digit matrices such as 0.7071 must pass, as they do at the
  // client.
  for (int i = 0; i < 3; i++) {
    if (std::abs(rotation.col(i).norm() - 1.0) > kTolerance ||
        std::abs(rotation.row(i).norm() - 1.0) > kTolerance ||
        std::abs(rotation.col(i).dot(rotation.col((i + 1) % 3))) > kTolerance) {
      return false;
    }
  }
  return rotation.determinant() > 0.0;
}

}  // namespace

Transform multiply(const Transform& a, const Transform& b) noexcept {
  Transform product;
  Eigen::Map<Eigen::Matrix4d>(product.data()).noalias() =
      Eigen::Map<const Eigen::Matrix4d>(a.data()) * Eigen::Map<const Eigen::Matrix4d>(b.data());
  return product;
}

bool isTransform(const Transform& matrix) noexcept {
  const bool finite =
      std::all_of(matrix.begin(), matrix.end(), [](double value) { return std::isfinite(value); });
  if (!finite) {
    return false;
  }
  const Eigen::Map<const Eigen::Matrix4d> m(matrix.data());
  const Eigen::RowVector4d bottom(0, 0, 0, 1);
  if ((m.row(3) - bottom).cwiseAbs().maxCoeff() > kTolerance) {
    return false;
  }
  return isRotation(m.topLeftCorner<3, 3>());
}

}  // namespace franka_sim_mujoco
