// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>

/// @file
/// The gravity of a World. The thread that uses the world calls these functions, between ticks.
/// Not real-time safe.

namespace franka_sim {

std::array<double, 3> gravity(const World& world);  ///< [m/s^2]
/// [m/s^2]; a reset does not change it.
void setGravity(World& world, const std::array<double, 3>& gravity);

}  // namespace franka_sim
