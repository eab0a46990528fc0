// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "arm_chain.h"

namespace franka_core {

using spatial::Joints;
using spatial::Pose;
using spatial::Vector;

ArmModel::ArmModel(const std::array<Link, 7>& links, const std::array<double, 16>& flange)
    : links_(links), flange_(flange) {}

std::array<double, 16> ArmModel::pose(ArmFrame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const noexcept {
  Joints joints;
  jointPoses(links_, q, spatial::jointsBefore(frame), joints);
  return toArray(framePose(frame, joints, flange_, F_T_EE, EE_T_K));
}

std::array<double, 42> ArmModel::zeroJacobian(ArmFrame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const noexcept {
  Joints joints;
  const std::size_t count = spatial::jointsBefore(frame);
  jointPoses(links_, q, count, joints);
  std::array<double, 42> jacobian;
  fillZeroJacobian(joints, count, framePose(frame, joints, flange_, F_T_EE, EE_T_K).p, jacobian);
  return jacobian;
}

std::array<double, 42> ArmModel::bodyJacobian(ArmFrame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const noexcept {
  Joints joints;
  const std::size_t count = spatial::jointsBefore(frame);
  jointPoses(links_, q, count, joints);
  const Pose tip = framePose(frame, joints, flange_, F_T_EE, EE_T_K);
  std::array<double, 42> jacobian;
  fillZeroJacobian(joints, count, tip.p, jacobian);
  for (std::size_t i = 0; i < 7; i++) {
    double* column = &jacobian[6 * i];
    const Vector linear = spatial::toVector(column);
    const Vector angular = spatial::toVector(column + 3);
    spatial::writeColumn(column, {dot(tip.x, linear), dot(tip.y, linear), dot(tip.z, linear)},
                         {dot(tip.x, angular), dot(tip.y, angular), dot(tip.z, angular)});
  }
  return jacobian;
}

}  // namespace franka_core
