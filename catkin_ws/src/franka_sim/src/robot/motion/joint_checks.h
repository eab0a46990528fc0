// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/motion/joint_motion.h>
#include <franka_sim/robot/motion/motion_limits.h>

#include <array>

namespace franka_sim {

/// The flag of each rule, and the factor on the jerk limit.
struct JointFlags {
  franka_core::RobotError position, velocity, acceleration, jerk;
  double jerk_factor;
};

/// Every rule, position to jerk, that a step violates.
/// @param last the sample before it.
ErrorSet judge(const JointSample& step, const JointSample& last, const JointFlags& flags,
               const MotionLimits& limits) noexcept;

/// The same for the rule of the jerk alone.
ErrorSet judgeJerk(const JointSample& step, const JointSample& last, const JointFlags& flags,
                   const MotionLimits& limits) noexcept;

/// The step from last to positions [rad], or by velocities [rad/s].
JointSample stepToPositions(const JointSample& last, const std::array<double, 7>& q) noexcept;
JointSample stepByVelocities(const JointSample& last, const std::array<double, 7>& dq) noexcept;
/// The step that keeps the acceleration.
JointSample stepByAcceleration(const JointSample& last) noexcept;
/// A history as a client reads it from states of 32 bit floats.
JointSample asEchoed(const JointSample& sample) noexcept;

}  // namespace franka_sim
