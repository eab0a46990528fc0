// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace franka_sim {

/// The rotation of a rotation vector [rad].
inline Eigen::Matrix3d rotationFrom(const Eigen::Vector3d& vector) noexcept {
  const double angle = vector.norm();
  if (!(angle > 0.0)) {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

/// The rotation vector [rad] of a rotation.
inline Eigen::Vector3d vectorOf(const Eigen::Matrix3d& rotation) noexcept {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The rotation nearest to an approximate rotation matrix. Newton's iteration for the polar factor:
/// unlike a conversion to quaternions it is smooth, so that rounded matrices cause no jerk. Errors
/// of 1e-5 vanish in three steps (1e-10, 1e-20).
inline Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& matrix) noexcept {
  Eigen::Matrix3d rotation = matrix;
  for (int i = 0; i < 3; i++) {
    const Eigen::Matrix3d square = rotation.transpose() * rotation;
    rotation = Eigen::Matrix3d(rotation * (3.0 * Eigen::Matrix3d::Identity() - square) * 0.5);
  }
  return rotation;
}

}  // namespace franka_sim
