// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/transform.h>
#include <franka_sim/robot/transforms.h>

#include <Eigen/Core>

namespace franka_sim {

Transform multiply(const Transform& a, const Transform& b) noexcept {
  Transform product;
  Eigen::Map<Eigen::Matrix4d>(product.data()).noalias() =
      Eigen::Map<const Eigen::Matrix4d>(a.data()) * Eigen::Map<const Eigen::Matrix4d>(b.data());
  return product;
}

bool isTransform(const Transform& matrix) noexcept { return franka_core::isRigidTransform(matrix); }

}  // namespace franka_sim
