// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>

namespace franka_sim {

/// 4x4 column-major, as everywhere in the FCI.
using Transform = std::array<double, 16>;

/// a times b.
Transform multiply(const Transform& a, const Transform& b) noexcept;

/// J dq [m/s, rad/s]. @param jacobian J, 6x7 column-major @param dq [rad/s]
std::array<double, 6> twist(const std::array<double, 42>& jacobian,
                            const std::array<double, 7>& dq) noexcept;

/// Sign of the elbow in the states: +1 where joint 4 is at or above franka_core::kElbowFlip, else
/// -1. Real-time safe. Thread-safe.
/// @param q joint positions [rad]
inline double elbowSign(const std::array<double, 7>& q) noexcept {
  return q[3] >= franka_core::kElbowFlip ? 1.0 : -1.0;
}

/// The elbow: position of joint 3 [rad] and elbowSign(). Real-time safe. Thread-safe.
inline std::array<double, 2> elbowOf(const std::array<double, 7>& q) noexcept {
  return {{q[2], elbowSign(q)}};
}

}  // namespace franka_sim
