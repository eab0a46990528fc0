// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/joint_motion.h"

#include <franka_core/finite.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/limits/motion_checks.h"

namespace franka_sim {

using franka_core::RobotError;

namespace {

constexpr double kStartTolerance = 1e-3;  // [rad] (decision 13)
// Jerk limit of joints that follow a Cartesian command, relative to commanded joints. Chosen here:
// a step between the two acceleration limits is 4 times the jerk limit, so that any larger factor
// would disable the flag.
constexpr double kSolvedJerkFactor = 3.5;

JointFlags commanded(const franka_core::MotionLimits& limits) noexcept {
  return {limits.positionFlag(false), RobotError::kJointMotionGeneratorVelocityLimitsViolation,
          RobotError::kJointMotionGeneratorVelocityDiscontinuity,
          RobotError::kJointMotionGeneratorAccelerationDiscontinuity, 1.0};
}

JointFlags solved(const franka_core::MotionLimits& limits) noexcept {
  return {limits.positionFlag(true),
          RobotError::kCartesianMotionGeneratorJointVelocityLimitsViolation,
          RobotError::kCartesianMotionGeneratorJointVelocityDiscontinuity,
          RobotError::kCartesianMotionGeneratorJointAccelerationDiscontinuity, kSolvedJerkFactor};
}

using Step = JointSample (*)(const JointSample&, const std::array<double, 7>&);

// Fails only if both histories fail; the exact one determines the flags.
ErrorSet checkWithEcho(Step make, const std::array<double, 7>& command, const JointSample& last,
                       const franka_core::MotionLimits& limits) noexcept {
  const JointFlags flags = commanded(limits);
  const ErrorSet errors = checkStep(make(last, command), last, flags, limits);
  if (!errors || !limits.echoes_floats) {
    return errors;
  }
  const JointSample seen = asEchoed(last);
  return checkStep(make(seen, command), seen, flags, limits) ? errors : ErrorSet{};
}

}  // namespace

void JointMotion::start(const std::array<double, 7>& q) noexcept {
  last_ = JointSample{};
  last_.q = q;
  started_ = false;
}

ErrorSet JointMotion::takePositions(const std::array<double, 7>& q_c,
                                    const franka_core::MotionLimits& limits) noexcept {
  if (!franka_core::allFinite(q_c)) {
    return RobotError::kJointMotionGeneratorVelocityLimitsViolation;  // no velocity leads there
  }
  JointSample step = stepToPositions(last_, q_c);
  if (!started_) {
    for (std::size_t i = 0; i < 7; i++) {
      if (std::abs(q_c[i] - last_.q[i]) > kStartTolerance) {
        return RobotError::kJointPositionMotionGeneratorStartPoseInvalid;
      }
    }
    step = JointSample{};
    step.q = q_c;
  }
  const ErrorSet errors = started_ ? checkWithEcho(franka_core::stepToPositions, q_c, last_, limits)
                                   : checkStep(step, last_, commanded(limits), limits);
  if (!errors) {
    last_ = step;
    started_ = true;
  }
  return errors;
}

ErrorSet JointMotion::takeVelocities(const std::array<double, 7>& dq_c,
                                     const franka_core::MotionLimits& limits) noexcept {
  if (!franka_core::allFinite(dq_c)) {
    return RobotError::kJointMotionGeneratorVelocityLimitsViolation;
  }
  const ErrorSet errors = checkWithEcho(franka_core::stepByVelocities, dq_c, last_, limits);
  if (!errors) {
    last_ = stepByVelocities(last_, dq_c);
    started_ = true;
  }
  return errors;
}

ErrorSet JointMotion::takeSolved(const std::array<double, 7>& q, bool first,
                                 const franka_core::MotionLimits& limits) noexcept {
  JointSample step = stepToPositions(last_, q);
  if (first) {
    step = JointSample{};
    step.q = q;
  }
  const ErrorSet errors = checkStep(step, last_, solved(limits), limits);
  if (!errors) {
    last_ = step;
    started_ = true;
  }
  return errors;
}

ErrorSet JointMotion::checkJump(const std::array<double, 7>& q,
                                const franka_core::MotionLimits& limits) const noexcept {
  return checkJerk(stepToPositions(last_, q), last_, solved(limits), limits);
}

ErrorSet JointMotion::extrapolate(const franka_core::MotionLimits& limits) noexcept {
  if (!started_) {
    return {};
  }
  const JointSample step = stepByAcceleration(last_);
  const ErrorSet errors = checkStep(step, last_, commanded(limits), limits);
  if (!errors) {
    last_ = step;
  }
  return errors;
}

ErrorSet JointMotion::checkStop(const franka_core::MotionLimits& limits) const noexcept {
  return checkStep(stepByVelocities(last_, {}), last_, commanded(limits), limits);
}

}  // namespace franka_sim
