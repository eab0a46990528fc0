// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/limits/measured_limits.h"

#include <algorithm>
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
