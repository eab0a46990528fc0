// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_core/rotations.h>
#include <franka_core/transform.h>
#include <franka_core/typed_transform.h>

#include <Eigen/Core>

namespace franka_core {

namespace {

/// Orthonormal as far as double precision allows: such a matrix is not changed.
constexpr double kExact = 1e-12;

}  // namespace

TypedTransform readTypedTransform(const std::array<double, 16>& matrix) {
  TypedTransform typed{matrix, roughTransformFault(matrix, kTypedTransformTolerance), ""};
  if (!typed.fault.empty()) {
    return typed;
  }
  Eigen::Map<Eigen::Matrix4d> pose(typed.matrix.data());
  const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
  const Eigen::Matrix3d square = rotation.transpose() * rotation;
  if ((square - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kExact) {
    return typed;
  }
  // Errors of 1e-3 vanish in its three steps (1e-6, 1e-12, 1e-24).
  const Eigen::Matrix3d nearest = orthonormalized(rotation);
  pose.topLeftCorner<3, 3>() = nearest;
  const double correction = (nearest - rotation).cwiseAbs().maxCoeff();
  if (correction > kSilentCorrection) {
    typed.warning =
        "its rotation is orthonormal only within rounding; the nearest rotation is used, which "
        "differs by up to " +
        numberText(correction, 2) + ". Give more digits to set an exact one";
  }
  return typed;
}

}  // namespace franka_core
