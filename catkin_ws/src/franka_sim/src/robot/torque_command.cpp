// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/finite.h>
#include <franka_sim/robot/tick.h>
#include <franka_sim/robot/torque_command.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

std::array<double, 7> saturate(const std::array<double, 7>& tau,
                               const std::array<double, 7>& limit) noexcept {
  std::array<double, 7> result;
  for (std::size_t i = 0; i < 7; i++) {
    result[i] = std::isfinite(tau[i]) ? std::clamp(tau[i], -limit[i], limit[i]) : 0.0;
  }
  return result;
}

bool TorqueCommand::jumps(const std::array<double, 7>& tau) const noexcept {
  constexpr double kStep = (1000.0 + 0.01) * kTick;
  for (std::size_t i = 0; i < 7; i++) {
    const double step = std::min(std::abs(tau[i] - tau_[i]), std::abs(tau[i] - commanded_[i]));
    if (!(step <= kStep)) {
      return true;
    }
  }
  return false;
}

bool TorqueCommand::receive(const std::array<double, 7>& tau) noexcept {
  if (!franka_core::allFinite(tau)) {
    return false;
  }
  commanded_ = tau;
  tau_ = saturate(tau, limit_);
  return true;
}

}  // namespace franka_sim
