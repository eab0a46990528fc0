// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace franka_sim {

/// The rotation about a vector by its length [rad].
inline Eigen::Matrix3d rotationFrom(const Eigen::Vector3d& vector) noexcept {
  const double angle = vector.norm();
  if (!(angle > 0.0)) {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

/// The vector of a rotation: its axis, as long as its angle [rad].
inline Eigen::Vector3d vectorOf(const Eigen::Matrix3d& rotation) noexcept {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The rotation nearest to a matrix that nearly is one. Newton's iteration for the polar factor:
/// unlike a detour over quaternions it is smooth, so that rounded matrices cause no jerk. Errors of
/// 1e-5 vanish in three steps (1e-10, 1e-20).
inline Eigen::Matrix3d orthonormalised(const Eigen::Matrix3d& matrix) noexcept {
  Eigen::Matrix3d rotation = matrix;
  for (int i = 0; i < 3; i++) {
    const Eigen::Matrix3d square = rotation.transpose() * rotation;
    rotation = Eigen::Matrix3d(rotation * (3.0 * Eigen::Matrix3d::Identity() - square) * 0.5);
  }
  return rotation;
}

}  // namespace franka_sim
