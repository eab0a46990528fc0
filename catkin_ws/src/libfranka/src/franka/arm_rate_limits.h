// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace franka {

/// Limits of the rate limiter: those of the connected robot, each smaller by a margin (as in
/// franka/rate_limiting.h). Its functions are pure and noexcept. Real-time safe.
struct ArmRateLimits {
  using Joints = std::array<double, 7>;

  Joints torque_rate;         ///< [Nm/s]
  Joints joint_acceleration;  ///< [rad/s^2]
  Joints joint_jerk;          ///< [rad/s^3]
  Joints joint_velocity;      ///< if it does not depend on the position [rad/s]
  /// If it does: the robot's limits with their margin [rad/s].
  std::optional<franka_core::PositionVelocityLimits> position_velocity;
  double velocity_margin;
  franka_core::DerivativeLimits translation, rotation, elbow;

  /// Highest and lowest joint velocities at q [rad/s].
  Joints upperJointVelocity(const Joints& q) const noexcept;
  Joints lowerJointVelocity(const Joints& q) const noexcept;

  /// Joint velocities kept within all limits, from velocities and accelerations of the cycle
  /// before. If the velocity limit depends on the position, they brake before a joint's end early
  /// enough to keep velocity, acceleration and jerk limits together. @param q desired joint
  /// positions [rad].
  Joints limitVelocities(const Joints& q, const Joints& velocities, const Joints& last_velocities,
                         const Joints& last_accelerations) const noexcept;
  /// The same for joint positions.
  Joints limitPositions(const Joints& positions, const Joints& last_positions,
                        const Joints& last_velocities,
                        const Joints& last_accelerations) const noexcept;
};

/// The limits of a robot with this protocol: the Panda's constants up to version 5, those of the
/// FR3 from version 6 on; system 5.9 (version 10) has other velocities (protocol 5.5), and the URDF
/// from such a robot overrides them.
ArmRateLimits rateLimitsOfProtocol(std::uint16_t version);

/// Joint velocity limits from a robot's description: for each of joint1 ... joint7 (by exact name,
/// else the first whose name contains it) `<limit lower upper velocity>` and
/// `<position_based_velocity_limits velocity_offset deceleration_limit>`.
/// @returns nothing if the description lacks one of them.
std::optional<franka_core::PositionVelocityLimits> velocityLimitsFromUrdf(const std::string& urdf);

}  // namespace franka
