// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <franka_core/numbers.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_core {

namespace {
constexpr unsigned kFirstFr3 = 6;
constexpr unsigned kFirstOf572 = 9;  // system 5.7.2: without flags 12 and 27
constexpr unsigned kFirstOf59 = 10;  // system 5.9: floats on the wire, its own limit tables
}  // namespace

double MotionLimits::highestVelocity(std::size_t joint, double q) const noexcept {
  const double limit = arm.dq[joint];
  return position_velocity ? std::min(limit, upperVelocityLimit(velocity_near_ends, joint, q))
                           : limit;
}

double MotionLimits::lowestVelocity(std::size_t joint, double q) const noexcept {
  const double limit = -arm.dq[joint];
  return position_velocity ? std::max(limit, lowerVelocityLimit(velocity_near_ends, joint, q))
                           : limit;
}

JointRange MotionLimits::reach(std::size_t joint) const noexcept {
  JointRange range{arm.q_min[joint], arm.q_max[joint]};
  if (position_velocity) {
    const JointRange reachable = reachOf(velocity_near_ends, joint);
    range.lowest = std::max(range.lowest, reachable.lowest);
    range.highest = std::min(range.highest, reachable.highest);
  }
  return range;
}

JointRange MotionLimits::reachFrom(std::size_t joint, double q) const noexcept {
  const JointRange range = reach(joint);
  return {std::min(range.lowest, q), std::max(range.highest, q)};
}

std::string MotionLimits::reachText(std::size_t joint, double q) const {
  constexpr int kDecimals = 4;
  constexpr double kDigits = 1e4;
  const JointRange range = reach(joint);
  return "between " + fixedText(std::ceil(range.lowest * kDigits) / kDigits, kDecimals) + " and " +
         fixedText(std::floor(range.highest * kDigits) / kDigits, kDecimals) + " rad, not at " +
         numberText(q, 9);
}

DerivativeLimits MotionLimits::elbow() const noexcept {
  DerivativeLimits limits = arm.elbow;
  limits.velocity = std::max(limits.velocity, arm.documented_elbow_velocity);
  return limits;
}

RobotError MotionLimits::positionFlag(bool solved) const noexcept {
  if (!own_position_flags) {
    return RobotError::kJointPositionLimitsViolation;
  }
  return solved ? RobotError::kCartesianMotionGeneratorJointPositionLimitsViolation
                : RobotError::kJointMotionGeneratorPositionLimitsViolation;
}

MotionLimits motionLimitsOfProtocol(unsigned version) noexcept {
  MotionLimits limits;
  limits.arm = limitsOfProtocol(version);
  limits.position_velocity = version >= kFirstFr3;
  limits.velocity_near_ends = fr3VelocityLimitsOfProtocol(version);
  limits.own_position_flags = version < kFirstOf572;
  limits.echoes_floats = version >= kFirstOf59;
  return limits;
}

}  // namespace franka_core
