// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/arm_model.h>
#include <franka_core/motion_steps.h>
#include <franka_core/rotations.h>
#include <franka_core/tick.h>

#include <Eigen/Core>
#include <cstddef>

namespace franka_core {

namespace {

using Eigen::Vector3d;
using Derivative = std::array<double, 6>;
using Pose = Eigen::Map<const Eigen::Matrix4d>;

Vector3d part(const Derivative& values, std::size_t first) noexcept {
  return {values[first], values[first + 1], values[first + 2]};
}

void differentiate(const JointSample& last, JointSample& step) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    step.ddq[i] = (step.dq[i] - last.dq[i]) / kTick;
    step.dddq[i] = (step.ddq[i] - last.ddq[i]) / kTick;
  }
}

void differentiate(const CartesianSample& last, CartesianSample& step) noexcept {
  for (std::size_t i = 0; i < 6; i++) {
    step.acceleration[i] = (step.twist[i] - last.twist[i]) / kTick;
    step.jerk[i] = (step.acceleration[i] - last.acceleration[i]) / kTick;
  }
}

// The pose one tick later at a twist in O.
std::array<double, 16> moved(const std::array<double, 16>& pose, const Derivative& twist) noexcept {
  const Pose from(pose.data());
  std::array<double, 16> result = kIdentityTransform;
  Eigen::Map<Eigen::Matrix4d> to(result.data());
  const Eigen::Matrix3d turned = rotationFrom(part(twist, 3) * kTick) * from.topLeftCorner<3, 3>();
  to.topLeftCorner<3, 3>() = orthonormalized(turned);
  to.topRightCorner<3, 1>() = from.topRightCorner<3, 1>() + part(twist, 0) * kTick;
  return result;
}

}  // namespace

JointSample stepToPositions(const JointSample& last, const std::array<double, 7>& q) noexcept {
  JointSample step;
  step.q = q;
  for (std::size_t i = 0; i < 7; i++) {
    step.dq[i] = (q[i] - last.q[i]) / kTick;
  }
  differentiate(last, step);
  return step;
}

JointSample stepByVelocities(const JointSample& last, const std::array<double, 7>& dq) noexcept {
  JointSample step;
  step.dq = dq;
  for (std::size_t i = 0; i < 7; i++) {
    step.q[i] = last.q[i] + dq[i] * kTick;
  }
  differentiate(last, step);
  return step;
}

JointSample stepByAcceleration(const JointSample& last) noexcept {
  JointSample step;
  step.ddq = last.ddq;
  for (std::size_t i = 0; i < 7; i++) {
    step.dq[i] = last.dq[i] + last.ddq[i] * kTick;
    step.q[i] = last.q[i] + step.dq[i] * kTick;
  }
  return step;
}

ElbowSample stepToElbow(const ElbowSample& last, double q3) noexcept {
  ElbowSample step;
  step.q3 = q3;
  step.dq3 = (q3 - last.q3) / kTick;
  step.ddq3 = (step.dq3 - last.dq3) / kTick;
  step.dddq3 = (step.ddq3 - last.ddq3) / kTick;
  return step;
}

CartesianSample stepToPose(const CartesianSample& last, const std::array<double, 16>& pose,
                           double q3) noexcept {
  const Pose from(last.pose.data());
  const Pose to(pose.data());
  CartesianSample step;
  step.pose = pose;
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(step.twist.data()) = twistBetween(from, to, kTick);
  differentiate(last, step);
  step.elbow = stepToElbow(last.elbow, q3);
  return step;
}

CartesianSample stepByTwist(const CartesianSample& last, const Derivative& twist,
                            double q3) noexcept {
  CartesianSample step;
  step.twist = twist;
  step.pose = moved(last.pose, twist);
  differentiate(last, step);
  step.elbow = stepToElbow(last.elbow, q3);
  return step;
}

CartesianSample stepByAcceleration(const CartesianSample& last) noexcept {
  CartesianSample step;
  step.acceleration = last.acceleration;
  for (std::size_t i = 0; i < 6; i++) {
    step.twist[i] = last.twist[i] + last.acceleration[i] * kTick;
  }
  step.pose = moved(last.pose, step.twist);
  step.elbow.ddq3 = last.elbow.ddq3;
  step.elbow.dq3 = last.elbow.dq3 + last.elbow.ddq3 * kTick;
  step.elbow.q3 = last.elbow.q3 + step.elbow.dq3 * kTick;
  return step;
}

}  // namespace franka_core
