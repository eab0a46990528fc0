// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/arm_model.h>
#include <franka_core/finite.h>
#include <franka_core/rotations.h>
#include <franka_sim/robot/motion/cartesian_motion.h>
#include <franka_sim/robot/tick.h>

#include <algorithm>
#include <cmath>

#include "robot/motion/cartesian_checks.h"

namespace franka_sim {

using franka_core::RobotError;

namespace {

constexpr double kPoseTolerance = 1e-3;   // [m]; [rad] likewise (decision 13)
constexpr double kElbowTolerance = 1e-3;  // [rad] (decision 13)

bool isNear(const CartesianSample& step) noexcept {
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> twist(step.twist.data());
  return twist.head<3>().norm() * kTick <= kPoseTolerance &&
         twist.tail<3>().norm() * kTick <= kPoseTolerance;
}

Transform tidied(const Transform& pose) noexcept {
  Transform tidy = franka_core::kIdentityTransform;
  const Eigen::Map<const Eigen::Matrix4d> from(pose.data());
  Eigen::Map<Eigen::Matrix4d> to(tidy.data());
  to.topLeftCorner<3, 3>() = franka_core::orthonormalised(from.topLeftCorner<3, 3>());
  to.topRightCorner<3, 1>() = from.topRightCorner<3, 1>();
  return tidy;
}

CartesianSample atRest(const Transform& pose, double q3) noexcept {
  CartesianSample sample;
  sample.pose = pose;
  sample.elbow.q3 = q3;
  return sample;
}

}  // namespace

void CartesianMotion::start(const Transform& pose, const std::array<double, 2>& elbow) noexcept {
  last_ = atRest(pose, elbow[0]);
  started_ = false;
}

MotionFault CartesianMotion::checkElbow(const ElbowCommand& command, double sign) const noexcept {
  if (!command.valid) {
    return {};
  }
  if (!std::isfinite(command.elbow[0])) {
    return RobotError::kCartesianMotionGeneratorElbowLimitViolation;
  }
  if (command.elbow[1] != sign) {
    return RobotError::kCartesianMotionGeneratorElbowSignInconsistent;
  }
  if (!started_ && std::abs(command.elbow[0] - last_.elbow.q3) > kElbowTolerance) {
    return RobotError::kCartesianMotionGeneratorStartElbowInvalid;
  }
  return {};
}

MotionFault CartesianMotion::takePose(const Transform& pose, const ElbowCommand& elbow, double sign,
                                      const MotionLimits& limits) noexcept {
  if (!isTransform(pose)) {
    return RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag;
  }
  const double q3 = elbow.valid ? elbow.elbow[0] : last_.elbow.q3;
  CartesianSample step = stepToPose(last_, tidied(pose), q3);
  if (!started_ && !isNear(step)) {
    return RobotError::kCartesianPositionMotionGeneratorStartPoseInvalid;
  }
  if (const MotionFault fault = checkElbow(elbow, sign)) {
    return fault;
  }
  if (!started_) {
    step = atRest(step.pose, q3);
  }
  MotionFault fault = judge(step, last_, limits);
  // Against the history as read by the client, the exact command counts, as in the client.
  if (fault && limits.echoes_floats && started_) {
    const CartesianSample seen = asEchoed(last_);
    fault = judge(stepToPose(seen, pose, q3), seen, limits) ? fault : MotionFault{};
  }
  if (!fault) {
    last_ = step;
    started_ = true;
  }
  return fault;
}

MotionFault CartesianMotion::takeTwist(const std::array<double, 6>& twist,
                                       const ElbowCommand& elbow, double sign,
                                       const MotionLimits& limits) noexcept {
  if (!franka_core::allFinite(twist)) {
    return RobotError::kCartesianMotionGeneratorVelocityLimitsViolation;
  }
  if (const MotionFault fault = checkElbow(elbow, sign)) {
    return fault;
  }
  const double q3 = elbow.valid ? elbow.elbow[0] : last_.elbow.q3;
  if (!started_) {
    last_.elbow.q3 = q3;  // within the tolerance; the elbow's history starts here
  }
  const CartesianSample step = stepByTwist(last_, twist, q3);
  MotionFault fault = judge(step, last_, limits);
  if (fault && limits.echoes_floats) {
    const CartesianSample seen = asEchoed(last_);
    fault = judge(stepByTwist(seen, twist, q3), seen, limits) ? fault : MotionFault{};
  }
  if (!fault) {
    last_ = step;
    started_ = true;
  }
  return fault;
}

MotionFault CartesianMotion::extrapolate(const MotionLimits& limits) noexcept {
  if (!started_) {
    return {};
  }
  const CartesianSample step = stepByAcceleration(last_);
  const MotionFault fault = judge(step, last_, limits);
  if (!fault) {
    last_ = step;
  }
  return fault;
}

MotionFault CartesianMotion::checkStop(const MotionLimits& limits) const noexcept {
  return judge(stepByTwist(last_, {}, last_.elbow.q3), last_, limits);
}

}  // namespace franka_sim
