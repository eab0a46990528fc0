// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace franka_sim {

/// Values as a client reads them from a state of 32 bit floats.
inline double asEchoed(double value) noexcept {
  // Volatile, because GCC 12 at -O2 otherwise treats two neighbouring conversions as a copy and
  // drops the rounding.
  const volatile float narrow = static_cast<float>(value);
  return narrow;
}

template <std::size_t kSize>
std::array<double, kSize> asEchoed(std::array<double, kSize> values) noexcept {
  for (double& value : values) {
    value = asEchoed(value);
  }
  return values;
}

}  // namespace franka_sim
