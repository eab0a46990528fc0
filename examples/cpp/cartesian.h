// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>

/// @file
/// Poses as springs of the end effector need them.

namespace example {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector7 = Eigen::Matrix<double, 7, 1>;

/// @param columns 4x4, column-major
inline Eigen::Isometry3d toPose(const std::array<double, 16>& columns) {
  return Eigen::Isometry3d(Eigen::Matrix4d::Map(columns.data()));
}

/// Way [m] and turn [rad] from one pose to another, in the axes of the base.
inline Vector6 difference(const Eigen::Isometry3d& to, const Eigen::Isometry3d& from) {
  const Eigen::AngleAxisd turn(to.linear() * from.linear().transpose());
  Vector6 result;
  result << to.translation() - from.translation(), turn.angle() * turn.axis();
  return result;
}

}  // namespace example
