// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/torque_command.h"

#include <franka_core/finite.h>
#include <franka_core/tick.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/laws/saturate.h"

namespace franka_sim {

bool TorqueCommand::jumps(const std::array<double, 7>& tau) const noexcept {
  constexpr double kStep = (1000.0 + 0.01) * franka_core::kTick;
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
