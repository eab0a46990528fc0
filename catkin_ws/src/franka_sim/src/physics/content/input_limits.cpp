// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/input_limits.h>

#include <cmath>
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
    throw std::runtime_error(what + " is " + franka_core::numberText(value) + " " + unit +
                             "; at most " + franka_core::numberText(largest) + " " + unit +
                             " are simulated.");
  }
}

}  // namespace franka_sim::sizes
