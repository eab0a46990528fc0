// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace franka_sim {

inline Eigen::Vector3d vector(const std::array<double, 3>& values) {
  return Eigen::Vector3d::Map(values.data());
}

inline std::array<double, 3> array(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Pose of a rigid transform. Real-time safe. Thread-safe.
inline Pose toPose(const Eigen::Isometry3d& transform) {
  const Eigen::Quaterniond turn(transform.linear());
  return {array(transform.translation()), {turn.w(), turn.x(), turn.y(), turn.z()}};
}

/// Orientation (w, x, y, z) as it is, without normalization. Real-time safe. Thread-safe.
inline Eigen::Quaterniond quaternion(const Pose& pose) {
  return {pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]};
}

/// Whether the orientation is a unit quaternion, to the digits that users write. Real-time safe.
/// Thread-safe.
inline bool hasUnitOrientation(const Pose& pose) {
  return std::abs(quaternion(pose).norm() - 1) < 1e-3;
}

/// Rigid transform of a pose whose orientation is not zero; normalizes it. Real-time safe.
/// Thread-safe.
inline Eigen::Isometry3d toIsometry(const Pose& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translation() = vector(pose.position);
  transform.linear() = quaternion(pose).normalized().toRotationMatrix();
  return transform;
}

}  // namespace franka_sim
