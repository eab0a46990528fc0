// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/sizes.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace franka_sim::sizes {

void check(const std::array<double, 3>& values, double largest, const char* unit,
           const std::string& what) {
  for (const double value : values) {
    check(value, largest, unit, what);
  }
}

void check(double value, double largest, const char* unit, const std::string& what) {
  if (!std::isfinite(value)) {
    throw std::runtime_error(what + " is not finite; give numbers in " + unit + ".");
  }
  if (std::abs(value) > largest) {
    char text[96];
    std::snprintf(text, sizeof(text), " is %g %s; at most %g %s are simulated.", value, unit,
                  largest, unit);
    throw std::runtime_error(what + text);
  }
}

}  // namespace franka_sim::sizes
