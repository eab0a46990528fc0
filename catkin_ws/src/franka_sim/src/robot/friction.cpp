// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/friction.h>

#include <cmath>
#include <cstddef>

namespace franka_sim {

std::array<double, 7> frictionCompensation(const std::array<double, 7>& coulomb,
                                           const std::array<double, 7>& viscous,
                                           const std::array<double, 7>& dq) noexcept {
  constexpr double kMoving = 0.01;  // [rad/s] (decision 1)
  std::array<double, 7> tau{};
  for (std::size_t i = 0; i < 7; i++) {
    if (std::abs(dq[i]) > kMoving) {
      tau[i] = std::copysign(coulomb[i], dq[i]) + viscous[i] * dq[i];
    }
  }
  return tau;
}

}  // namespace franka_sim
