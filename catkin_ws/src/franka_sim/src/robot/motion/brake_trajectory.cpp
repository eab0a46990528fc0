// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/brake_trajectory.h"

#include <franka_core/tick.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/motion/landing_rate.h"

namespace franka_sim {

using franka_core::kTick;

void BrakeTrajectory::start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                            const std::array<double, 7>& ddq_d,
                            const franka_core::ArmLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    q_[i] = q_d[i];
    dq_[i] = std::isfinite(dq_d[i]) ? dq_d[i] : 0.0;
    ddq_max_[i] = limits.ddq[i];
    change_[i] = limits.dddq[i] * kTick;
    ddq_[i] = std::isfinite(ddq_d[i]) ? std::clamp(ddq_d[i], -ddq_max_[i], ddq_max_[i]) : 0.0;
  }
}

void BrakeTrajectory::step() noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const double direction = dq_[i] < 0.0 ? -1.0 : 1.0;
    const double landing = landingRate(std::abs(dq_[i]), change_[i]);
    const double braking = std::min({landing, ddq_max_[i], -direction * ddq_[i] + change_[i]});
    // The last step sets 0 itself, without rounding.
    const bool landed = braking == landing && landing <= change_[i];
    const double next = landed ? 0.0 : dq_[i] - direction * braking * kTick;
    ddq_[i] = (next - dq_[i]) / kTick;
    dq_[i] = next;
    q_[i] += next * kTick;
  }
}

bool BrakeTrajectory::atRest() const noexcept {
  const auto zero = [](double v) { return v == 0.0; };
  return std::all_of(dq_.begin(), dq_.end(), zero) && std::all_of(ddq_.begin(), ddq_.end(), zero);
}

}  // namespace franka_sim
