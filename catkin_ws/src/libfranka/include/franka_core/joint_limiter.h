// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <algorithm>
#include <array>
#include <cstddef>

// Keeps joint commands within velocity, acceleration and jerk, for libfranka's client and the
// simulated robot's controllers. All functions are pure. Real-time safe. Thread-safe.

namespace franka_core {

/// Share of a joint's acceleration limit that braking before its end may use (chosen here: the rest
/// is a reserve for the limiter's lag).
constexpr double kBrakingShare = 0.9;

/// Velocity limits that a limiter can follow, within the robot's limits that shrink towards the
/// joints' ends.
///
/// An FR3's velocity limit falls towards the ends of joints 5 and 7 faster than they can brake
/// (limits.h). These limits fall only as fast as a joint can follow, and are lower than the robot's
/// by the limiter's lag and by the speed gained while the jerk limit turns full acceleration into
/// braking.
/// @param max_acceleration [rad/s^2] @param max_jerk [rad/s^3], of each joint
/// @param margin to the velocity limit far from the ends [rad/s]
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

/// Allowed velocities of the joints [rad/s].
struct JointVelocityRange {
  std::array<double, 7> lowest;   ///< [rad/s]
  std::array<double, 7> highest;  ///< [rad/s]
};

/// The range that these limits allow at position q [rad].
inline JointVelocityRange rangeAt(const PositionVelocityLimits& limits,
                                  const std::array<double, 7>& q) noexcept {
  JointVelocityRange range{};
  for (std::size_t i = 0; i < 7; i++) {
    range.lowest[i] = lowerVelocityLimit(limits, i, q[i]);
    range.highest[i] = upperVelocityLimit(limits, i, q[i]);
  }
  return range;
}

/// The velocity nearest to the desired one within jerk and acceleration limits, with the
/// acceleration ending at the velocity limit; the two velocity limits may differ (protocol 5.6).
/// @param lowest,highest velocity [rad/s] @param dt a cycle [s]
/// @param last_velocity [rad/s] @param last_acceleration [rad/s^2] of the cycle before
inline double limitVelocity(double lowest, double highest, double max_acceleration, double max_jerk,
                            double velocity, double last_velocity, double last_acceleration,
                            double dt) noexcept {
  const double jerk = ((velocity - last_velocity) / dt - last_acceleration) / dt;
  const double acceleration = last_acceleration + std::clamp(jerk, -max_jerk, max_jerk) * dt;
  const double stiffness = max_jerk / max_acceleration;
  const double up = std::min(stiffness * (highest - last_velocity), max_acceleration);
  const double down = std::max(stiffness * (lowest - last_velocity), -max_acceleration);
  const double desired =
      std::clamp(std::max(std::min(acceleration, up), down), -max_acceleration, max_acceleration);
  // Approaching ends must not change the acceleration faster than the jerk limit.
  const double change = std::clamp(desired - last_acceleration, -max_jerk * dt, max_jerk * dt);
  return last_velocity + (last_acceleration + change) * dt;
}

/// The same for all joints of an arm.
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
