// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim_mujoco {

/// 4x4 column-major, as everywhere in the FCI.
using Transform = std::array<double, 16>;

/// a times b.
Transform multiply(const Transform& a, const Transform& b) noexcept;

/// Whether a matrix is a rigid motion: finite, bottom row 0 0 0 1, columns and rows of the rotation
/// of unit length and at right angles, right-handed; each within 1e-5 (as the FCI client checks,
/// fci.md 4.3).
bool isTransform(const Transform& matrix) noexcept;

}  // namespace franka_sim_mujoco
