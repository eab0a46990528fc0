// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/measured_limits.h>

#include <cmath>
#include <cstddef>

namespace franka_sim {

using franka_core::RobotError;

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

std::optional<RobotError> measuredViolation(const franka_core::ArmLimits& limits,
                                            const franka_core::RobotState& state,
                                            const std::array<double, 6>& O_dP_EE) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (std::abs(state.tau_J[i]) > kTorqueMargin * limits.tau[i]) {
      return RobotError::kTauJRangeViolation;
    }
  }
  if (beyondJointLimits(limits, state.q)) {
    return RobotError::kJointPositionLimitsViolation;
  }
  double power = 0.0;
  for (std::size_t i = 0; i < 7; i++) {
    if (std::abs(state.dq[i]) > kSpeedMargin * limits.dq[i]) {
      return RobotError::kJointVelocityViolation;
    }
    power += std::abs(state.tau_J[i] * state.dq[i]);
  }
  if (std::hypot(O_dP_EE[0], O_dP_EE[1], O_dP_EE[2]) > kSpeedMargin * limits.translation.velocity) {
    return RobotError::kCartesianVelocityViolation;
  }
  if (power > kPowerLimit) {
    return RobotError::kPowerLimitViolation;
  }
  return std::nullopt;
}

}  // namespace franka_sim
