// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace franka_sim {

/// Thresholds of contact (lower) and collision (upper), [Nm] and [N, N, N, Nm, Nm, Nm].
struct CollisionThresholds {
  std::array<double, 7> lower_torque, upper_torque;  ///< seven joints
  std::array<double, 6> lower_force, upper_force;    ///< x, y, z
};

/// Which magnitudes are above their thresholds: 1 or 0, as the flags of RobotState. Real-time safe.
template <std::size_t N>
std::array<double, N> above(const std::array<double, N>& values,
                            const std::array<double, N>& thresholds) noexcept;

}  // namespace franka_sim
