// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/landing_rate.h"

#include <franka_core/tick.h>

#include <cmath>

namespace franka_sim {

using franka_core::kTick;

// From the rate r the value changes by kTick (r + (r - step) + ...); with n whole steps in r that
// is kTick ((n + 1) r - step n (n + 1) / 2).
double landingRate(double distance, double step) noexcept {
  const double units = distance / (step * kTick);
  const double n = std::floor((std::sqrt(1.0 + 8.0 * units) - 1.0) * 0.5);
  return (distance / kTick + step * n * (n + 1.0) * 0.5) / (n + 1.0);
}

}  // namespace franka_sim
