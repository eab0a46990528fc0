// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// @file
/// Rotations and rotation vectors: the direction is the axis, the length the angle [rad].
/// Real-time safe. Thread-safe.

namespace franka_core {

/// The rotation about a vector by the vector's length.
inline Eigen::Matrix3d rotationFrom(const Eigen::Vector3d& vector) noexcept {
  const double angle = vector.norm();
  if (!(angle > 0.0)) {
    return Eigen::Matrix3d::Identity();
  }
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

/// The rotation vector of a rotation.
inline Eigen::Vector3d vectorOf(const Eigen::AngleAxisd& turn) noexcept {
  return turn.angle() * turn.axis();
}
inline Eigen::Vector3d vectorOf(const Eigen::Matrix3d& rotation) noexcept {
  return vectorOf(Eigen::AngleAxisd(rotation));
}

/// The constant twist from one pose (4x4) to another in a period [s]: linear, then angular, in the
/// axes of the frame of both poses.
inline Eigen::Matrix<double, 6, 1> twistBetween(const Eigen::Matrix4d& from,
                                                const Eigen::Matrix4d& to, double period) noexcept {
  const Eigen::Matrix3d turn = to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose();
  Eigen::Matrix<double, 6, 1> twist;
  twist << (to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>()) / period,
      vectorOf(turn) / period;
  return twist;
}

/// The rotation by roll, pitch and yaw about fixed axes, as in URDF and SDF: Rz(yaw) Ry(pitch)
/// Rx(roll).
inline Eigen::Matrix3d rotationFromRpy(const Eigen::Vector3d& rpy) noexcept {
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

/// The rotation nearest to a matrix that is almost a rotation. Newton's iteration for the polar
/// factor: unlike a conversion over quaternions it is smooth, so that rounded matrices cause no
/// jerk. Errors of 1e-5 vanish in three steps (1e-10, 1e-20).
inline Eigen::Matrix3d orthonormalized(const Eigen::Matrix3d& matrix) noexcept {
  Eigen::Matrix3d rotation = matrix;
  for (int i = 0; i < 3; i++) {
    const Eigen::Matrix3d square = rotation.transpose() * rotation;
    rotation = Eigen::Matrix3d(rotation * (3.0 * Eigen::Matrix3d::Identity() - square) * 0.5);
  }
  return rotation;
}

}  // namespace franka_core
