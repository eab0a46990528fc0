// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// 4x4 column-major, as everywhere in the FCI.
using Transform = std::array<double, 16>;

/// a times b.
Transform multiply(const Transform& a, const Transform& b) noexcept;

/// J dq [m/s, rad/s]. @param jacobian J, 6x7 column-major @param dq [rad/s]
std::array<double, 6> twist(const std::array<double, 42>& jacobian,
                            const std::array<double, 7>& dq) noexcept;

/// Whether the control unit takes a matrix as a pose or a frame: franka_core::isRigidTransform.
bool isTransform(const Transform& matrix) noexcept;

}  // namespace franka_sim
