// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>
#include <cfloat>
#include <cstddef>

/// @file
/// Limits of the Panda (FER) as used by its client, and functions that keep commands within them.
/// The constants are smaller than the robot's own limits by a margin, so that a command at the
/// limit is accepted also after lost packets. The functions are pure. Real-time safe. Thread-safe.

namespace franka {

constexpr double kDeltaT = 1e-3;               ///< one cycle [s]
constexpr double kLimitEps = 1e-3;             ///< margin kept from each limit, in the limit's unit
constexpr double kNormEps = DBL_EPSILON;       ///< vectors shorter than this have no direction
constexpr double kTolNumberPacketsLost = 3.0;  ///< packets in a row that may be lost
constexpr double kFactorCartesianRotationPoseInterface =
    0.99;  ///< share of the rotation limits for poses

namespace rate_limiting_detail {
constexpr double withMargin(double limit) { return limit - kLimitEps; }
/// Velocity margin: the change by the acceleration while packets are lost.
constexpr double withMargin(double velocity, double acceleration) {
  return velocity - kLimitEps - kTolNumberPacketsLost * kDeltaT * withMargin(acceleration);
}
constexpr std::array<double, 7> withMargin(const std::array<double, 7>& limits) {
  return {{withMargin(limits[0]), withMargin(limits[1]), withMargin(limits[2]),
           withMargin(limits[3]), withMargin(limits[4]), withMargin(limits[5]),
           withMargin(limits[6])}};
}
constexpr std::array<double, 7> withMargin(const std::array<double, 7>& velocities,
                                           const std::array<double, 7>& accelerations) {
  return {{withMargin(velocities[0], accelerations[0]), withMargin(velocities[1], accelerations[1]),
           withMargin(velocities[2], accelerations[2]), withMargin(velocities[3], accelerations[3]),
           withMargin(velocities[4], accelerations[4]), withMargin(velocities[5], accelerations[5]),
           withMargin(velocities[6], accelerations[6])}};
}
static constexpr const franka_core::ArmLimits& kFer = franka_core::kFerLimits;

/// The limits of an FR3 at q [rad], each kLimitEps smaller: without a margin for lost packets.
inline std::array<double, 7> upperJointVelocities(const franka_core::PositionVelocityLimits& limits,
                                                  const std::array<double, 7>& q) noexcept {
  std::array<double, 7> velocities{};
  for (std::size_t i = 0; i < 7; i++) {
    velocities[i] = franka_core::upperVelocityLimit(limits, i, q[i]) - kLimitEps;
  }
  return velocities;
}
inline std::array<double, 7> lowerJointVelocities(const franka_core::PositionVelocityLimits& limits,
                                                  const std::array<double, 7>& q) noexcept {
  std::array<double, 7> velocities{};
  for (std::size_t i = 0; i < 7; i++) {
    velocities[i] = franka_core::lowerVelocityLimit(limits, i, q[i]) + kLimitEps;
  }
  return velocities;
}
}  // namespace rate_limiting_detail

/// Torque rate [Nm/s].
constexpr std::array<double, 7> kMaxTorqueRate =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.dtau);
/// Joint jerk [rad/s^3].
constexpr std::array<double, 7> kMaxJointJerk =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.dddq);
/// Joint acceleration [rad/s^2].
constexpr std::array<double, 7> kMaxJointAcceleration =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.ddq);
/// Joint velocity [rad/s].
constexpr std::array<double, 7> kMaxJointVelocity = rate_limiting_detail::withMargin(
    rate_limiting_detail::kFer.rate_limiter_dq, rate_limiting_detail::kFer.ddq);
/// Translational jerk [m/s^3].
constexpr double kMaxTranslationalJerk =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.translation.jerk);
/// Translational acceleration [m/s^2].
constexpr double kMaxTranslationalAcceleration =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.translation.acceleration);
/// Translational velocity [m/s].
constexpr double kMaxTranslationalVelocity =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.translation.velocity,
                                     rate_limiting_detail::kFer.translation.acceleration);
/// Rotational jerk [rad/s^3].
constexpr double kMaxRotationalJerk =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.rotation.jerk);
/// Rotational acceleration [rad/s^2].
constexpr double kMaxRotationalAcceleration =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.rotation.acceleration);
/// Rotational velocity [rad/s].
constexpr double kMaxRotationalVelocity = rate_limiting_detail::withMargin(
    rate_limiting_detail::kFer.rotation.velocity, rate_limiting_detail::kFer.rotation.acceleration);
/// Elbow jerk [rad/s^3].
constexpr double kMaxElbowJerk =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.elbow.jerk);
/// Elbow acceleration [rad/s^2].
constexpr double kMaxElbowAcceleration =
    rate_limiting_detail::withMargin(rate_limiting_detail::kFer.elbow.acceleration);
/// Elbow velocity [rad/s].
constexpr double kMaxElbowVelocity = rate_limiting_detail::withMargin(
    rate_limiting_detail::kFer.elbow.velocity, rate_limiting_detail::kFer.elbow.acceleration);

/// Elbow velocity in the other direction [rad/s].
constexpr double kMinElbowVelocity = -kMaxElbowVelocity;

/// Highest velocity of each joint of an FR3 at q [rad/s], by the published table (systems before
/// 5.9). Robot::getUpperJointVelocityLimits returns the limits of the connected robot.
/// Real-time safe.
/// @param q joint positions [rad].
inline std::array<double, 7> computeUpperLimitsJointVelocity(
    const std::array<double, 7>& q) noexcept {
  return rate_limiting_detail::upperJointVelocities(franka_core::kFr3PositionVelocityLimits, q);
}
/// Lowest velocity, as computeUpperLimitsJointVelocity.
inline std::array<double, 7> computeLowerLimitsJointVelocity(
    const std::array<double, 7>& q) noexcept {
  return rate_limiting_detail::lowerJointVelocities(franka_core::kFr3PositionVelocityLimits, q);
}

/// Limits the rate of seven values.
/// @param max_derivatives largest change per second of each value.
/// @param commanded_values desired values. @param last_commanded_values values of the cycle before.
/// @throws std::invalid_argument if a desired value is not finite.
std::array<double, 7> limitRate(const std::array<double, 7>& max_derivatives,
                                const std::array<double, 7>& commanded_values,
                                const std::array<double, 7>& last_commanded_values);

/// Limits a velocity and its two derivatives.
/// @param max_velocity, max_acceleration, max_jerk limits of one joint [rad/s, rad/s^2, rad/s^3].
/// @param commanded_velocity desired velocity [rad/s].
/// @param last_commanded_velocity, last_commanded_acceleration values of the cycle before.
/// @throws std::invalid_argument if the desired velocity is not finite.
double limitRate(double max_velocity, double max_acceleration, double max_jerk,
                 double commanded_velocity, double last_commanded_velocity,
                 double last_commanded_acceleration);

/// Limits a position and its three derivatives; arguments as for the velocity, positions in [rad].
///
/// libfranka 0.11 and later have a function with the same seven arguments that limits a velocity:
/// (upper_velocity, lower_velocity, max_acceleration, max_jerk, commanded_velocity,
/// last_commanded_velocity, last_commanded_acceleration). A second argument of at most kLimitEps
/// cannot be an acceleration limit, so it is treated as a lower velocity limit and the call as one
/// of that function. Programs for either release thus work.
/// @throws std::invalid_argument if the desired value is not finite.
double limitRate(double max_velocity, double max_acceleration, double max_jerk,
                 double commanded_position, double last_commanded_position,
                 double last_commanded_velocity, double last_commanded_acceleration);

/// Limits a position, between a lower and an upper limit of its velocity [rad/s] (libfranka 0.11
/// and later). @throws std::invalid_argument if the desired position is not finite.
double limitRate(double upper_velocity, double lower_velocity, double max_acceleration,
                 double max_jerk, double commanded_position, double last_commanded_position,
                 double last_commanded_velocity, double last_commanded_acceleration);

/// The velocity version for seven joints. @throws std::invalid_argument if a desired value is not
/// finite.
std::array<double, 7> limitRate(const std::array<double, 7>& max_velocity,
                                const std::array<double, 7>& max_acceleration,
                                const std::array<double, 7>& max_jerk,
                                const std::array<double, 7>& commanded_velocities,
                                const std::array<double, 7>& last_commanded_velocities,
                                const std::array<double, 7>& last_commanded_accelerations);

/// The position version for seven joints, or, where a value of the second argument is at most
/// kLimitEps, the velocity version of libfranka 0.11 and later (see the version for one joint):
/// (upper_velocity, lower_velocity, max_acceleration, max_jerk, commanded_velocities,
/// last_commanded_velocities, last_commanded_accelerations).
/// @throws std::invalid_argument if a desired value is not finite.
std::array<double, 7> limitRate(const std::array<double, 7>& max_velocity,
                                const std::array<double, 7>& max_acceleration,
                                const std::array<double, 7>& max_jerk,
                                const std::array<double, 7>& commanded_positions,
                                const std::array<double, 7>& last_commanded_positions,
                                const std::array<double, 7>& last_commanded_velocities,
                                const std::array<double, 7>& last_commanded_accelerations);

/// The position version between lower and upper velocity limits for seven joints.
/// @throws std::invalid_argument if a desired value is not finite.
std::array<double, 7> limitRate(const std::array<double, 7>& upper_velocity,
                                const std::array<double, 7>& lower_velocity,
                                const std::array<double, 7>& max_acceleration,
                                const std::array<double, 7>& max_jerk,
                                const std::array<double, 7>& commanded_positions,
                                const std::array<double, 7>& last_commanded_positions,
                                const std::array<double, 7>& last_commanded_velocities,
                                const std::array<double, 7>& last_commanded_accelerations);

/// Limits a twist: the norms of its linear and of its angular part, each with two derivatives.
/// @param O_dP_EE_c desired twist in O [m/s, rad/s].
/// @param last_O_dP_EE_c, last_O_ddP_EE_c twist and acceleration of the cycle before, in O.
/// @throws std::invalid_argument if a desired value is not finite.
std::array<double, 6> limitRate(double max_translational_velocity,
                                double max_translational_acceleration,
                                double max_translational_jerk, double max_rotational_velocity,
                                double max_rotational_acceleration, double max_rotational_jerk,
                                const std::array<double, 6>& O_dP_EE_c,
                                const std::array<double, 6>& last_O_dP_EE_c,
                                const std::array<double, 6>& last_O_ddP_EE_c);

/// Limits a pose: the twist that leads to it from the last pose, with two derivatives. For the
/// rotation 99 % of the limits are used.
/// @param O_T_EE_c desired pose in O, 4x4 column-major.
/// @param last_O_T_EE_c, last_O_dP_EE_c, last_O_ddP_EE_c values of the cycle before, in O.
/// @throws std::invalid_argument if the desired pose is not finite or no homogeneous
/// transformation.
std::array<double, 16> limitRate(double max_translational_velocity,
                                 double max_translational_acceleration,
                                 double max_translational_jerk, double max_rotational_velocity,
                                 double max_rotational_acceleration, double max_rotational_jerk,
                                 const std::array<double, 16>& O_T_EE_c,
                                 const std::array<double, 16>& last_O_T_EE_c,
                                 const std::array<double, 6>& last_O_dP_EE_c,
                                 const std::array<double, 6>& last_O_ddP_EE_c);

}  // namespace franka
