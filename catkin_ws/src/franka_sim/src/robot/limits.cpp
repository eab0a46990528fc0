// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/robot/limits.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

using franka_core::RobotError;

namespace {
constexpr unsigned kFirstFr3 = 6;
constexpr unsigned kFirstOf572 = 9;  // system 5.7.2: without flags 12 and 27
constexpr unsigned kFirstOf59 = 10;  // system 5.9: floats on the wire, its own limit tables
}  // namespace

double MotionLimits::highestVelocity(std::size_t joint, double q) const noexcept {
  const double limit = arm.dq[joint];
  return position_velocity
             ? std::min(limit, franka_core::upperVelocityLimit(velocity_near_ends, joint, q))
             : limit;
}

double MotionLimits::lowestVelocity(std::size_t joint, double q) const noexcept {
  const double limit = -arm.dq[joint];
  return position_velocity
             ? std::max(limit, franka_core::lowerVelocityLimit(velocity_near_ends, joint, q))
             : limit;
}

franka_core::JointRange MotionLimits::reach(std::size_t joint) const noexcept {
  franka_core::JointRange range{arm.q_min[joint], arm.q_max[joint]};
  if (position_velocity) {
    const franka_core::JointRange reachable = franka_core::reachOf(velocity_near_ends, joint);
    range.lowest = std::max(range.lowest, reachable.lowest);
    range.highest = std::min(range.highest, reachable.highest);
  }
  return range;
}

franka_core::JointRange MotionLimits::reachFrom(std::size_t joint, double q) const noexcept {
  const franka_core::JointRange range = reach(joint);
  return {std::min(range.lowest, q), std::max(range.highest, q)};
}

std::string MotionLimits::reachText(std::size_t joint, double q) const {
  constexpr int kDecimals = 4;
  constexpr double kDigits = 1e4;
  const franka_core::JointRange range = reach(joint);
  return "between " +
         franka_core::fixedText(std::ceil(range.lowest * kDigits) / kDigits, kDecimals) + " and " +
         franka_core::fixedText(std::floor(range.highest * kDigits) / kDigits, kDecimals) +
         " rad, not at " + franka_core::numberText(q, 9);
}

franka_core::DerivativeLimits MotionLimits::elbow() const noexcept {
  franka_core::DerivativeLimits limits = arm.elbow;
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
  limits.arm = franka_core::limitsOfProtocol(version);
  limits.position_velocity = version >= kFirstFr3;
  limits.velocity_near_ends = version >= kFirstOf59 ? franka_core::kFr3PositionVelocityLimitsFrom59
                                                    : franka_core::kFr3PositionVelocityLimits;
  limits.own_position_flags = version < kFirstOf572;
  limits.echoes_floats = version >= kFirstOf59;
  return limits;
}

namespace {

constexpr double kPositionMargin = 0.005;  // [rad], chosen here: below the stops' 0.02 (decision 8)
// For joints and hand: the arm overshoots commands at 100 % of the limit (decision 14).
constexpr double kSpeedMargin = 1.05;
constexpr double kTorqueMargin = 1.2;  // (decision 14)

}  // namespace

bool beyondJointLimits(const franka_core::ArmLimits& limits,
                       const std::array<double, 7>& q) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (q[i] < limits.q_min[i] - kPositionMargin || q[i] > limits.q_max[i] + kPositionMargin) {
      return true;
    }
  }
  return false;
}

ErrorSet measuredViolations(const franka_core::ArmLimits& limits,
                            const franka_core::RobotState& state,
                            const std::array<double, 6>& O_dP_EE) noexcept {
  bool strong = false;
  bool fast = false;
  double power = 0.0;
  for (std::size_t i = 0; i < 7; i++) {
    strong |= std::abs(state.tau_J[i]) > kTorqueMargin * limits.tau[i];
    fast |= std::abs(state.dq[i]) > kSpeedMargin * limits.dq[i];
    power += std::abs(state.tau_J[i] * state.dq[i]);
  }
  const double speed = std::hypot(O_dP_EE[0], O_dP_EE[1], O_dP_EE[2]);
  ErrorSet errors;
  errors.addIf(strong, RobotError::kTauJRangeViolation);
  errors.addIf(fast, RobotError::kJointVelocityViolation);
  errors.addIf(beyondJointLimits(limits, state.q), RobotError::kJointPositionLimitsViolation);
  errors.addIf(speed > kSpeedMargin * limits.translation.velocity,
               RobotError::kCartesianVelocityViolation);
  errors.addIf(power > kPowerLimit, RobotError::kPowerLimitViolation);
  return errors;
}

}  // namespace franka_sim
