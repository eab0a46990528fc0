// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace franka_sim {

/// Contact and collision of N signals (decision 15). Contact is 1 while lower < |x| <= upper;
/// collision becomes 1 when |x| > upper, and stays until it is cleared. Flags are 0 or 1, as in
/// RobotState. Called by one thread. Real-time safe.
template <std::size_t N>
class ContactMonitor {
 public:
  void update(const std::array<double, N>& values, const std::array<double, N>& lower,
              const std::array<double, N>& upper) noexcept {
    for (std::size_t i = 0; i < N; i++) {
      const double magnitude = std::abs(values[i]);
      contact_[i] = magnitude > lower[i] && magnitude <= upper[i] ? 1.0 : 0.0;
      if (magnitude > upper[i]) {
        collision_[i] = 1.0;
      }
    }
  }

  void clear() noexcept {
    contact_.fill(0.0);
    collision_.fill(0.0);
  }

  const std::array<double, N>& contact() const noexcept { return contact_; }
  const std::array<double, N>& collision() const noexcept { return collision_; }

 private:
  std::array<double, N> contact_{};
  std::array<double, N> collision_{};
};

}  // namespace franka_sim
