// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

/// @file
/// The limits of both arms, each once. Source: Franka's published tables (protocol 5.5). All
/// functions are pure. Real-time safe. Thread-safe.

namespace franka_core {

/// Largest load or end effector of simulated arms (chosen here: three times the payload of the arm,
/// and as far from the flange as its reach).
constexpr double kMaxPayloadMass = 10.0;     ///< [kg]
constexpr double kMaxPayloadDistance = 1.0;  ///< of the center of mass from the flange [m]
constexpr double kMaxPayloadInertia = 10.0;  ///< each entry [kg m^2]

/// Bounds on the magnitude of one Cartesian quantity and its derivatives.
struct DerivativeLimits {
  double velocity;      ///< [m/s] or [rad/s]
  double acceleration;  ///< [m/s^2] or [rad/s^2]
  double jerk;          ///< [m/s^3] or [rad/s^3]
};

/// All limits of an arm. Joint arrays are in the order of the joints.
struct ArmLimits {
  std::array<double, 7> q_min;             ///< lowest position [rad]
  std::array<double, 7> q_max;             ///< highest position [rad]
  std::array<double, 7> dq;                ///< velocity [rad/s]
  std::array<double, 7> ddq;               ///< acceleration [rad/s^2]
  std::array<double, 7> dddq;              ///< jerk [rad/s^3]
  std::array<double, 7> tau;               ///< torque [Nm]
  std::array<double, 7> dtau;              ///< torque rate [Nm/s]
  DerivativeLimits translation;            ///< of EE; velocity is that of the rate limiter
  DerivativeLimits rotation;               ///< of EE
  DerivativeLimits elbow;                  ///< of joint 3; velocity is that of the rate limiter
  double documented_translation_velocity;  ///< in the robot's data sheet [m/s]
  double documented_elbow_velocity;        ///< in the robot's data sheet [rad/s]
  std::array<double, 7> rate_limiter_dq;   ///< velocity limit of the client: dq, or less [rad/s]
};

namespace limits_detail {
constexpr ArmLimits ferLimits() {
  ArmLimits arm{};
  arm.q_min = {{-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973}};
  arm.q_max = {{2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973}};
  arm.dq = {{2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61}};
  arm.ddq = {{15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0}};
  arm.dddq = {{7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0}};
  arm.tau = {{87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0}};
  arm.dtau = {{1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 1000.0}};
  arm.translation = {2.0, 13.0, 6500.0};
  arm.rotation = {2.5, 25.0, 12500.0};
  arm.elbow = {2.175, 10.0, 5000.0};
  arm.documented_translation_velocity = 1.7;
  arm.documented_elbow_velocity = 2.175;
  arm.rate_limiter_dq = {{2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61}};
  return arm;
}
}  // namespace limits_detail

/// Panda, also called FER: protocols 3 to 5.
constexpr ArmLimits kFerLimits = limits_detail::ferLimits();

namespace limits_detail {
constexpr ArmLimits fr3Limits() {
  ArmLimits arm{};
  arm.q_min = {{-2.9007, -1.8361, -2.9007, -3.0770, -2.8763, 0.4398, -3.0508}};
  arm.q_max = {{2.9007, 1.8361, 2.9007, -0.1169, 2.8763, 4.6216, 3.0508}};
  arm.dq = {{2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26}};
  arm.ddq = {{10.0, 10.0, 10.0, 10.0, 10.0, 10.0, 10.0}};
  arm.dddq = {{5000.0, 5000.0, 5000.0, 5000.0, 5000.0, 5000.0, 5000.0}};
  arm.tau = {{87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0}};
  arm.dtau = {{1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 1000.0}};
  arm.translation = {3.0, 9.0, 4500.0};
  arm.rotation = {2.5, 17.0, 8500.0};
  arm.elbow = {1.5, 10.0, 5000.0};
  arm.documented_translation_velocity = 3.0;
  arm.documented_elbow_velocity = 2.62;
  arm.rate_limiter_dq = {{2.0, 1.0, 1.5, 1.25, 3.0, 1.5, 3.0}};
  return arm;
}
}  // namespace limits_detail

/// FR3 with system 5.9 or later: protocol 10 (decision 8).
constexpr ArmLimits kFr3Limits = limits_detail::fr3Limits();

namespace limits_detail {
constexpr ArmLimits fr3LimitsBefore59() {
  ArmLimits arm = kFr3Limits;
  arm.q_min = {{-2.7437, -1.7837, -2.9007, -3.0421, -2.8065, 0.5445, -3.0159}};
  arm.q_max = {{2.7437, 1.7837, 2.9007, -0.1518, 2.8065, 4.5169, 3.0159}};
  return arm;
}
}  // namespace limits_detail

/// FR3 before system 5.9: protocols 6 to 9. Only the position limits differ.
constexpr ArmLimits kFr3LimitsBefore59 = limits_detail::fr3LimitsBefore59();

/// The limits of a robot with this protocol version (decisions 8, 25).
constexpr const ArmLimits& limitsOfProtocol(unsigned version) noexcept {
  return version <= 5 ? kFerLimits : (version < 10 ? kFr3LimitsBefore59 : kFr3Limits);
}

/// Parameters of the joint velocity limit that shrinks towards the joint's ends.
struct PositionVelocityLimits {
  std::array<double, 7> velocity;      ///< V: limit far from the ends [rad/s]
  std::array<double, 7> offset;        ///< o: [rad/s]
  std::array<double, 7> deceleration;  ///< c: twice the deceleration towards the end [rad/s^2]
  std::array<double, 7> q_min;         ///< lower end [rad]
  std::array<double, 7> q_max;         ///< upper end [rad]
};

namespace limits_detail {
constexpr PositionVelocityLimits fr3PositionVelocityLimits() {
  PositionVelocityLimits limits{};
  limits.velocity = {{2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26}};
  limits.offset = {{0.30, 0.20, 0.20, 0.30, 0.35, 0.35, 0.35}};
  limits.deceleration = {{12.0, 5.17, 7.0, 8.0, 34.0, 11.0, 34.0}};
  limits.q_min = {{-2.7501, -1.7918, -2.9065, -3.0481, -2.8101, 0.54092, -3.0196}};
  limits.q_max = {{2.7501, 1.7918, 2.9065, -0.1458, 2.8101, 4.5205, 3.0196}};
  return limits;
}
}  // namespace limits_detail

/// FR3, as in the client's header since libfranka 0.11 (protocol 5.5).
constexpr PositionVelocityLimits kFr3PositionVelocityLimits =
    limits_detail::fr3PositionVelocityLimits();

namespace limits_detail {
constexpr PositionVelocityLimits fr3PositionVelocityLimitsFrom59() {
  PositionVelocityLimits limits{};
  limits.velocity = kFr3Limits.dq;
  limits.offset = {{0.6599, 0.2517, 0.2000, 0.3533, 0.5757, 0.4878, 0.4628}};
  limits.deceleration = {{12.0, 5.17, 7.0, 8.0, 34.0, 11.0, 34.0}};
  limits.q_min = kFr3Limits.q_min;
  limits.q_max = kFr3Limits.q_max;
  return limits;
}
}  // namespace limits_detail

/// FR3 with system 5.9 or later, as in the URDF for clients of protocol 10; c is twice the URDF's
/// deceleration (protocol 5.5).
constexpr PositionVelocityLimits kFr3PositionVelocityLimitsFrom59 =
    limits_detail::fr3PositionVelocityLimitsFrom59();

/// The joint velocity limits of an FR3 with this protocol version; clients of protocol 10 read them
/// from the URDF.
constexpr const PositionVelocityLimits& fr3VelocityLimitsOfProtocol(unsigned version) noexcept {
  return version < 10 ? kFr3PositionVelocityLimits : kFr3PositionVelocityLimitsFrom59;
}

/// Highest velocity of a joint (0 to 6) at position q [rad]: min(V, max(0, -o + sqrt(c (q_max -
/// q)))).
inline double upperVelocityLimit(const PositionVelocityLimits& limits, std::size_t joint,
                                 double q) noexcept {
  const double margin = std::max(0.0, limits.deceleration[joint] * (limits.q_max[joint] - q));
  return std::min(limits.velocity[joint], std::max(0.0, std::sqrt(margin) - limits.offset[joint]));
}

/// Lowest velocity of a joint (0 to 6) at position q [rad]: max(-V, min(0, o - sqrt(c (q -
/// q_min)))).
inline double lowerVelocityLimit(const PositionVelocityLimits& limits, std::size_t joint,
                                 double q) noexcept {
  const double margin = std::max(0.0, limits.deceleration[joint] * (q - limits.q_min[joint]));
  return std::max(-limits.velocity[joint], std::min(0.0, limits.offset[joint] - std::sqrt(margin)));
}

/// A range of joint positions [rad].
struct JointRange {
  double lowest;   ///< [rad]
  double highest;  ///< [rad]
};

/// Velocity that the limit must allow at a position for a motion to end there [rad/s] (chosen here:
/// a thousandth of a microradian per millisecond, well above the rounding of a limit of 0).
constexpr double kMinReachVelocity = 1e-6;

/// Reachable positions of a joint (0 to 6): beyond, the velocity limit towards the end is 0.
inline JointRange reachOf(const PositionVelocityLimits& limits, std::size_t joint) noexcept {
  const double offset = limits.offset[joint] + kMinReachVelocity;
  const double dead_zone = offset * offset / limits.deceleration[joint];
  return {limits.q_min[joint] + dead_zone, limits.q_max[joint] - dead_zone};
}

/// Position of joint 4 at which the elbow flips: elbow[1] is +1 above it, -1 below [rad].
constexpr double kElbowFlip = -0.467002423653011;

}  // namespace franka_core
