// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/safety/collision_thresholds.h>

#include <cmath>

namespace franka_sim {

template <std::size_t N>
std::array<double, N> above(const std::array<double, N>& values,
                            const std::array<double, N>& thresholds) noexcept {
  std::array<double, N> flags{};
  for (std::size_t i = 0; i < N; i++) {
    flags[i] = std::abs(values[i]) > thresholds[i] ? 1.0 : 0.0;
  }
  return flags;
}

template std::array<double, 6> above(const std::array<double, 6>&,
                                     const std::array<double, 6>&) noexcept;
template std::array<double, 7> above(const std::array<double, 7>&,
                                     const std::array<double, 7>&) noexcept;

}  // namespace franka_sim
