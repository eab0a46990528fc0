// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/dither.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace control_toolbox {

bool Dither::init(double amplitude, double seed) {
  constexpr double kMaxSeed = std::numeric_limits<std::uint32_t>::max();
  if (!std::isfinite(amplitude) || amplitude < 0.0 || !(std::abs(seed) <= kMaxSeed)) {
    return false;
  }
  amplitude_ = amplitude;
  random_.seed(static_cast<std::uint32_t>(static_cast<std::int64_t>(seed)));
  normal_.reset();
  return true;
}

double Dither::update() { return amplitude_ * normal_(random_); }

}  // namespace control_toolbox
