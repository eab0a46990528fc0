// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <algorithm>
#include <array>
#include <cstddef>

// How a joint's commands are kept within velocity, acceleration and jerk: libfranka's client and
// the simulated robot's controllers do it alike. All functions are pure and real-time safe.

namespace franka_core {

/// Of a joint's acceleration limit, how much braking before its end may need (our choice).
constexpr double kBrakingShare = 0.9;

/// Velocity limits that a limiter can follow, within those that shrink towards the joints' ends.
///
/// An FR3's velocity limit falls towards the ends of joints 5 and 7 faster than they may brake
/// (limits.h). These fall only as fast as can be followed, and lie below the robot's by what the
/// limiter lags behind and by what it gains while the jerk turns full acceleration into braking.
/// @param max_acceleration [rad/s^2] @param max_jerk [rad/s^3], of each joint
/// @param margin kept free of the velocity far from the ends [rad/s]
inline PositionVelocityLimits followable(PositionVelocityLimits limits,
                                         const std::array<double, 7>& max_acceleration,
                                         const std::array<double, 7>& max_jerk,
                                         double margin) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const double braking =
        std::min(limits.deceleration[i] / 2.0, kBrakingShare * max_acceleration[i]);
    const double turn = max_acceleration[i] + braking;
    limits.velocity[i] -= margin;
    limits.deceleration[i] = 2.0 * braking;
    limits.offset[i] += (braking * max_acceleration[i] + turn * turn / 2.0) / max_jerk[i];
  }
  return limits;
}

/// What the velocities of the joints may be [rad/s].
struct JointVelocityRange {
  std::array<double, 7> lowest;
  std::array<double, 7> highest;
};

/// The range that these limits leave at position q [rad].
inline JointVelocityRange rangeAt(const PositionVelocityLimits& limits,
                                  const std::array<double, 7>& q) noexcept {
  JointVelocityRange range{};
  for (std::size_t i = 0; i < 7; i++) {
    range.lowest[i] = lowerVelocityLimit(limits, i, q[i]);
    range.highest[i] = upperVelocityLimit(limits, i, q[i]);
  }
  return range;
}

/// The velocity nearest to the desired one within jerk and acceleration, where the acceleration
/// ends at the velocity limit; the two velocity limits may differ (protocol 5.6).
/// @param lowest @param highest velocity [rad/s] @param dt a cycle [s]
/// @param last_velocity [rad/s] @param last_acceleration [rad/s^2] of the cycle before
inline double limitVelocity(double lowest, double highest, double max_acceleration, double max_jerk,
                            double velocity, double last_velocity, double last_acceleration,
                            double dt) noexcept {
  const double jerk = ((velocity - last_velocity) / dt - last_acceleration) / dt;
  const double acceleration = last_acceleration + std::clamp(jerk, -max_jerk, max_jerk) * dt;
  const double stiffness = max_jerk / max_acceleration;
  const double up = std::min(stiffness * (highest - last_velocity), max_acceleration);
  const double down = std::max(stiffness * (lowest - last_velocity), -max_acceleration);
  const double wanted =
      std::clamp(std::max(std::min(acceleration, up), down), -max_acceleration, max_acceleration);
  // Ends that come nearer must not turn the acceleration faster than a wish may.
  const double change = std::clamp(wanted - last_acceleration, -max_jerk * dt, max_jerk * dt);
  return last_velocity + (last_acceleration + change) * dt;
}

/// The same for each of an arm's joints.
inline std::array<double, 7> limitVelocities(const JointVelocityRange& range,
                                             const std::array<double, 7>& max_acceleration,
                                             const std::array<double, 7>& max_jerk,
                                             const std::array<double, 7>& velocities,
                                             const std::array<double, 7>& last_velocities,
                                             const std::array<double, 7>& last_accelerations,
                                             double dt) noexcept {
  std::array<double, 7> limited{};
  for (std::size_t i = 0; i < 7; i++) {
    limited[i] = limitVelocity(range.lowest[i], range.highest[i], max_acceleration[i], max_jerk[i],
                               velocities[i], last_velocities[i], last_accelerations[i], dt);
  }
  return limited;
}

}  // namespace franka_core
