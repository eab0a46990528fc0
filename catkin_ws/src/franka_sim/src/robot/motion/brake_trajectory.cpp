// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/motion/brake_trajectory.h>
#include <franka_sim/robot/tick.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

void BrakeTrajectory::start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                            const std::array<double, 7>& ddq_max) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    q_[i] = q_d[i];
    dq_[i] = std::isfinite(dq_d[i]) ? dq_d[i] : 0.0;
  }
  ddq_.fill(0.0);
  ddq_max_ = ddq_max;
}

void BrakeTrajectory::step() noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const double change = std::min(std::abs(dq_[i]), ddq_max_[i] * kTick);
    const double next = dq_[i] - std::copysign(change, dq_[i]);
    ddq_[i] = (next - dq_[i]) / kTick;
    dq_[i] = next;
    q_[i] += next * kTick;
  }
}

bool BrakeTrajectory::atRest() const noexcept {
  return std::all_of(dq_.begin(), dq_.end(), [](double v) { return v == 0.0; });
}

}  // namespace franka_sim
