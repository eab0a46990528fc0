// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/robot/safety/collision.h>

#include <cmath>

namespace franka_sim {

namespace {

std::string against(const Collision& collision, const char* quantity, const char* unit) {
  const std::string value = franka_core::numberText(collision.value, 4);
  const std::string threshold = franka_core::numberText(collision.threshold, 4);
  return std::string("external ") + quantity + " " + value + " " + unit + ", upper threshold " +
         threshold + " " + unit;
}

}  // namespace

template <std::size_t N>
Collision worstOf(const std::array<double, N>& values,
                  const std::array<double, N>& upper) noexcept {
  Collision worst;
  for (std::size_t i = 0; i < N; i++) {
    const double value = std::abs(values[i]);
    // Ratios, cross-multiplied: a threshold may be 0.
    if (value > upper[i] &&
        (!worst.happened || value * worst.threshold > std::abs(worst.value) * upper[i])) {
      worst = {true, i, values[i], upper[i]};
    }
  }
  return worst;
}

template Collision worstOf(const std::array<double, 6>&, const std::array<double, 6>&) noexcept;
template Collision worstOf(const std::array<double, 7>&, const std::array<double, 7>&) noexcept;

std::string describeJointCollision(const Collision& collision) {
  return "joint " + std::to_string(collision.index + 1) + ": " + against(collision, "torque", "Nm");
}

std::string describeCartesianCollision(const Collision& collision, InterfaceRules rules) {
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  const std::string axis =
      std::string(kAxes[collision.index % 3]) + (checksWrenchInBase(rules) ? " of O" : " of K");
  return collision.index < 3 ? "along " + axis + ": " + against(collision, "force", "N")
                             : "about " + axis + ": " + against(collision, "torque", "Nm");
}

}  // namespace franka_sim
