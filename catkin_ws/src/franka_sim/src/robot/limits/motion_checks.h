// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>

#include <array>
#include <cstddef>

#include "robot/limits/error_set.h"
#include "robot/motion/cartesian_motion.h"
#include "robot/motion/joint_motion.h"

namespace franka_sim {

/// Values as a client reads them from a state of 32 bit floats.
inline double asEchoed(double value) noexcept {
  // Volatile, because GCC 12 at -O2 otherwise treats two neighboring conversions as a copy and
  // drops the rounding.
  const volatile float narrow = static_cast<float>(value);
  return narrow;
}

template <std::size_t kSize>
std::array<double, kSize> asEchoed(std::array<double, kSize> values) noexcept {
  for (double& value : values) {
    value = asEchoed(value);
  }
  return values;
}

/// The flag of each rule, and the factor on the jerk limit.
struct JointFlags {
  franka_core::RobotError position, velocity, acceleration, jerk;
  double jerk_factor;
};

/// Every rule, position to jerk, that a step violates.
/// @param last the sample before it.
ErrorSet checkStep(const JointSample& step, const JointSample& last, const JointFlags& flags,
                   const franka_core::MotionLimits& limits) noexcept;

/// The same for the rule of the jerk alone.
ErrorSet checkJerk(const JointSample& step, const JointSample& last, const JointFlags& flags,
                   const franka_core::MotionLimits& limits) noexcept;

/// A history as a client reads it from states of 32 bit floats.
JointSample asEchoed(const JointSample& sample) noexcept;

/// Every rule, position to jerk, that a step violates; all those of the elbow have one flag.
/// @param last the sample before it.
ErrorSet checkStep(const CartesianSample& step, const CartesianSample& last,
                   const franka_core::MotionLimits& limits) noexcept;

/// A history as a client reads it from states of 32 bit floats.
CartesianSample asEchoed(const CartesianSample& sample) noexcept;

}  // namespace franka_sim
