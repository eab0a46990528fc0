// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/force_watch.h"

#include <cmath>
#include <cstddef>

namespace franka_sim {

using franka_core::RobotError;

namespace {

// Chosen here (see ForceWatch): no rule is published.
constexpr double kTorqueTolerance = 10.0;  // [Nm]
constexpr int kMissedTicks = 100;          // [ticks]

}  // namespace

ErrorSet ForceWatch::update(const std::array<double, 7>& tau_ext,
                            const std::array<double, 7>& achieved,
                            const std::array<double, 7>& desired,
                            const std::array<double, 7>& range) noexcept {
  bool beyond = false;
  bool misses = false;
  for (std::size_t i = 0; i < 7; i++) {
    beyond |= std::abs(tau_ext[i]) > range[i];
    misses |= std::abs(achieved[i] - desired[i]) > kTorqueTolerance;
  }
  missed_ = misses ? missed_ + 1 : 0;
  ErrorSet errors;
  errors.addIf(beyond, RobotError::kForceControlSafetyViolation);
  errors.addIf(missed_ >= kMissedTicks, RobotError::kForceControllerDesiredForceToleranceViolation);
  return errors;
}

}  // namespace franka_sim
