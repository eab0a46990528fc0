// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace franka_sim {

class World;

/// Time of the bare mj_step calls of a tick [us], with the same model and substeps, from the
/// present state with the present torques held: the reference of the simulation's benchmark. Works
/// on copies of the state; the world does not change. Allocates.
double bareTickMicroseconds(World& world, std::uint32_t ticks);

}  // namespace franka_sim
