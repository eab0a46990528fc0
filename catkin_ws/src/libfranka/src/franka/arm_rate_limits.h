// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace franka {

/// What the rate limiter keeps commands within: the limits of the robot that was found, each a
/// margin smaller (as in franka/rate_limiting.h). Its functions are pure, noexcept and safe in the
/// 1 kHz loop.
struct ArmRateLimits {
  using Joints = std::array<double, 7>;

  Joints torque_rate;         ///< [Nm/s]
  Joints joint_acceleration;  ///< [rad/s^2]
  Joints joint_jerk;          ///< [rad/s^3]
  Joints joint_velocity;      ///< where it does not depend on the position [rad/s]
  /// Where it does: the robot's limits, and what stays free of them [rad/s].
  std::optional<franka_core::PositionVelocityLimits> position_velocity;
  double velocity_margin;
  franka_core::DerivativeLimits translation, rotation, elbow;

  /// Highest and lowest joint velocities at q [rad/s].
  Joints upperJointVelocity(const Joints& q) const noexcept;
  Joints lowerJointVelocity(const Joints& q) const noexcept;

  /// Joint velocities kept within all limits, from velocities and accelerations of the cycle
  /// before. Where the velocity limit depends on the position, they brake before a joint's end
  /// early enough to keep within velocity, acceleration and jerk at once.
  /// @param q where the arm is wanted now [rad].
  Joints limitVelocities(const Joints& q, const Joints& velocities, const Joints& last_velocities,
                         const Joints& last_accelerations) const noexcept;
  /// Joint positions likewise.
  Joints limitPositions(const Joints& positions, const Joints& last_positions,
                        const Joints& last_velocities,
                        const Joints& last_accelerations) const noexcept;
};

/// The limits of a robot that speaks this protocol: the Panda's constants up to version 5, those of
/// the FR3 from version 6 on; system 5.9 (version 10) has other velocities (protocol 5.5), and the
/// URDF that such a robot sends overrides them.
ArmRateLimits rateLimitsOfProtocol(std::uint16_t version);

/// Joint velocity limits from the description a robot sends: for each of joint1 ... joint7 (by
/// exact name, else the first whose name contains it) `<limit lower upper velocity>` and
/// `<position_based_velocity_limits velocity_offset deceleration_limit>`.
/// @returns nothing where the description lacks one of them.
std::optional<franka_core::PositionVelocityLimits> velocityLimitsFromUrdf(const std::string& urdf);

}  // namespace franka
