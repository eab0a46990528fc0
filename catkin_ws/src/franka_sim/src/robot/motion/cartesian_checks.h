// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/motion/cartesian_motion.h>
#include <franka_sim/robot/motion/motion_limits.h>

#include <array>

namespace franka_sim {

/// Every rule, position to jerk, that a step violates; all those of the elbow have one flag.
/// @param last the sample before it.
ErrorSet judge(const CartesianSample& step, const CartesianSample& last,
               const MotionLimits& limits) noexcept;

/// The step from last to a pose, or by a twist in O, with the elbow at q3 [rad].
CartesianSample stepToPose(const CartesianSample& last, const Transform& pose, double q3) noexcept;
CartesianSample stepByTwist(const CartesianSample& last, const std::array<double, 6>& twist,
                            double q3) noexcept;
/// The step that keeps the accelerations.
CartesianSample stepByAcceleration(const CartesianSample& last) noexcept;
/// A history as a client reads it from states of 32 bit floats.
CartesianSample asEchoed(const CartesianSample& sample) noexcept;

}  // namespace franka_sim
