// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// Damping of both impedance laws, times sqrt(stiffness * inertia): 0.7 of critical
/// (decisions 10, 11).
constexpr double kDampingFactor = 1.4;

}  // namespace franka_sim
