// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/transforms.h"

#include <franka_core/transform.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace franka_sim {

Transform multiply(const Transform& a, const Transform& b) noexcept {
  Transform product;
  Eigen::Map<Eigen::Matrix4d>(product.data()).noalias() =
      Eigen::Map<const Eigen::Matrix4d>(a.data()) * Eigen::Map<const Eigen::Matrix4d>(b.data());
  return product;
}

std::array<double, 6> twist(const std::array<double, 42>& jacobian,
                            const std::array<double, 7>& dq) noexcept {
  std::array<double, 6> result;
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(result.data()) =
      Eigen::Map<const Eigen::Matrix<double, 6, 7>>(jacobian.data())
          .lazyProduct(Eigen::Map<const Eigen::Matrix<double, 7, 1>>(dq.data()));
  return result;
}

}  // namespace franka_sim
