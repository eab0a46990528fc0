// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

namespace franka {

/// The rotation nearest to the upper left 3x3 block of a 4x4 column-major matrix (least sum of
/// squared differences), by a singular value decomposition. The (normalized) quaternion of a block
/// that is not quite orthogonal is a different rotation. Real-time safe.
inline Eigen::Matrix3d nearestRotation(const std::array<double, 16>& transform) {
  return Eigen::Affine3d(Eigen::Matrix4d::Map(transform.data())).rotation();
}

}  // namespace franka
