// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/saturate.h"

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

}  // namespace franka_sim
