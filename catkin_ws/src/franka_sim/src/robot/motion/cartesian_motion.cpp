// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/cartesian_motion.h"

#include <franka_core/arm_model.h>
#include <franka_core/finite.h>
#include <franka_core/rotations.h>
#include <franka_core/tick.h>
#include <franka_core/transform.h>

#include <Eigen/Core>
#include <cmath>

#include "robot/limits/motion_checks.h"

namespace franka_sim {

using franka_core::kTick;
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
  to.topLeftCorner<3, 3>() = franka_core::orthonormalized(from.topLeftCorner<3, 3>());
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

ErrorSet CartesianMotion::checkElbow(const ElbowCommand& command, double sign) const noexcept {
  ErrorSet errors;
  if (!command.valid) {
    return errors;
  }
  if (!std::isfinite(command.elbow[0])) {
    return RobotError::kCartesianMotionGeneratorElbowLimitViolation;
  }
  errors.addIf(command.elbow[1] != sign,
               RobotError::kCartesianMotionGeneratorElbowSignInconsistent);
  errors.addIf(!started_ && std::abs(command.elbow[0] - last_.elbow.q3) > kElbowTolerance,
               RobotError::kCartesianMotionGeneratorStartElbowInvalid);
  return errors;
}

ErrorSet CartesianMotion::takePose(const Transform& pose, const ElbowCommand& elbow, double sign,
                                   const franka_core::MotionLimits& limits) noexcept {
  has_refused_ = false;
  if (!franka_core::isRigidTransform(pose)) {
    return RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag;
  }
  const double q3 = elbow.valid ? elbow.elbow[0] : last_.elbow.q3;
  CartesianSample step = stepToPose(last_, tidied(pose), q3);
  ErrorSet errors = checkElbow(elbow, sign);
  errors.addIf(!started_ && !isNear(step),
               RobotError::kCartesianPositionMotionGeneratorStartPoseInvalid);
  if (errors) {
    return errors;
  }
  if (!started_) {
    step = atRest(step.pose, q3);
  }
  errors = checkStep(step, last_, limits);
  // Against the history as read by the client, the exact command counts, as in the client.
  if (errors && limits.echoes_floats && started_) {
    const CartesianSample seen = asEchoed(last_);
    errors = checkStep(stepToPose(seen, pose, q3), seen, limits) ? errors : ErrorSet{};
  }
  return take(step, errors);
}

ErrorSet CartesianMotion::takeTwist(const std::array<double, 6>& twist, const ElbowCommand& elbow,
                                    double sign, const franka_core::MotionLimits& limits) noexcept {
  has_refused_ = false;
  if (!franka_core::allFinite(twist)) {
    return RobotError::kCartesianMotionGeneratorVelocityLimitsViolation;
  }
  if (const ErrorSet errors = checkElbow(elbow, sign)) {
    return errors;
  }
  const double q3 = elbow.valid ? elbow.elbow[0] : last_.elbow.q3;
  if (!started_) {
    last_.elbow.q3 = q3;  // within the tolerance; the elbow's history starts here
  }
  const CartesianSample step = stepByTwist(last_, twist, q3);
  ErrorSet errors = checkStep(step, last_, limits);
  if (errors && limits.echoes_floats) {
    const CartesianSample seen = asEchoed(last_);
    errors = checkStep(stepByTwist(seen, twist, q3), seen, limits) ? errors : ErrorSet{};
  }
  return take(step, errors);
}

ErrorSet CartesianMotion::extrapolate(const franka_core::MotionLimits& limits) noexcept {
  has_refused_ = false;
  if (!started_) {
    return {};
  }
  const CartesianSample step = stepByAcceleration(last_);
  return take(step, checkStep(step, last_, limits));
}

// The end of each of these steps.
ErrorSet CartesianMotion::take(const CartesianSample& step, const ErrorSet& errors) noexcept {
  if (errors) {
    refused_ = step;
    has_refused_ = true;
  } else {
    last_ = step;
    started_ = true;
  }
  return errors;
}

ErrorSet CartesianMotion::checkStop(const franka_core::MotionLimits& limits) const noexcept {
  return checkStep(stepByTwist(last_, {}, last_.elbow.q3), last_, limits);
}

}  // namespace franka_sim
