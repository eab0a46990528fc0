// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/joint_command_interface.h>
#include <joint_limits_interface/joint_limits.h>
#include <joint_limits_interface/joint_limits_interface_exception.h>

#include <algorithm>
#include <limits>
#include <string>

namespace joint_limits_interface {
namespace internal {

/// `val` saturated to [min_val, max_val]; max_val if the bounds are crossed. NaN stays NaN.
template <typename T>
T saturate(const T val, const T min_val, const T max_val) {
  return std::min(std::max(val, min_val), max_val);
}

/// A closed interval of commands.
struct Bounds {
  double lower;
  double upper;

  static Bounds symmetric(double magnitude) { return {-magnitude, magnitude}; }
  double saturate(double value) const { return internal::saturate(value, lower, upper); }
};

constexpr double kUnlimited = std::numeric_limits<double>::max();

/// Velocities that the soft position limits allow at a position: proportional to the distance to
/// each limit, at most `max_velocity`.
inline Bounds softVelocityBounds(const SoftJointLimits& soft, double position,
                                 double max_velocity) {
  const Bounds hard = Bounds::symmetric(max_velocity);
  return {hard.saturate(-soft.k_position * (position - soft.min_position)),
          hard.saturate(-soft.k_position * (position - soft.max_position))};
}

/// Base of the handles: one joint and its limits. Derived handles have enforceLimits(), which the
/// control loop calls. Real-time safe. A NaN command passes, so that the robot's own check can stop
/// and report it, but no handle stores it: the next valid command is limited as if it had not
/// existed.
class LimitHandle {
 public:
  LimitHandle() = default;
  LimitHandle(const hardware_interface::JointHandle& jh, const JointLimits& limits)
      : jh_(jh), limits_(limits) {}

  std::string getName() const { return jh_.getName(); }

 protected:
  /// @param kind of the required limits, as in "velocity" @throws JointLimitsInterfaceException
  void require(bool has_limits, const char* kind) const {
    if (!has_limits) {
      throw JointLimitsInterfaceException("Cannot enforce limits for joint '" + getName() +
                                          "'. It has no " + kind + " limits specification.");
    }
  }

  hardware_interface::JointHandle jh_;
  JointLimits limits_;
};

}  // namespace internal
}  // namespace joint_limits_interface
