// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "spatial.h"

/// @file
/// The frames of the arm in one configuration; internal to ArmModel.

namespace franka_core {
namespace spatial {

using Joints = std::array<Pose, 7>;

/// Poses of the first `count` joints in O.
inline void jointPoses(const std::array<ArmModel::Link, 7>& links, const std::array<double, 7>& q,
                       std::size_t count, Joints& joints) noexcept {
  for (std::size_t i = 0; i < count; i++) {
    joints[i] = i == 0 ? toPose(links[0].origin) : compose(joints[i - 1], links[i].origin);
    turn(joints[i], q[i]);
  }
}

/// Number of joints that move the frame.
inline std::size_t jointsBefore(ArmFrame frame) noexcept {
  return frame < ArmFrame::kJoint7 ? static_cast<std::size_t>(frame) + 1 : 7;
}

/// Pose of a frame in O once the poses of the joints before it are known.
inline Pose framePose(ArmFrame frame, const Joints& joints, const std::array<double, 16>& flange,
                      const std::array<double, 16>& F_T_EE,
                      const std::array<double, 16>& EE_T_K) noexcept {
  Pose pose = joints[jointsBefore(frame) - 1];
  if (frame >= ArmFrame::kFlange) {
    pose = compose(pose, flange);
  }
  if (frame >= ArmFrame::kEndEffector) {
    pose = compose(pose, F_T_EE);
  }
  if (frame >= ArmFrame::kStiffness) {
    pose = compose(pose, EE_T_K);
  }
  return pose;
}

inline void writeColumn(double* column, const Vector& linear, const Vector& angular) noexcept {
  column[0] = linear.x;
  column[1] = linear.y;
  column[2] = linear.z;
  column[3] = angular.x;
  column[4] = angular.y;
  column[5] = angular.z;
}

/// Jacobian in O of the point `tip`, moved by the first `count` joints.
inline void fillZeroJacobian(const Joints& joints, std::size_t count, const Vector& tip,
                             std::array<double, 42>& jacobian) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const bool moves = i < count;
    writeColumn(&jacobian[6 * i],
                moves ? cross(joints[i].z, tip - joints[i].p) : Vector{0.0, 0.0, 0.0},
                moves ? joints[i].z : Vector{0.0, 0.0, 0.0});
  }
}

}  // namespace spatial
}  // namespace franka_core
