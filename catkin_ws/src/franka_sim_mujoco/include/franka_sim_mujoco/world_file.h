// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Finds a world's file: a path to an MJCF or SDF file, the name of a file in one of `folders`, or
/// the name of an MJCF world there ("stone", "worlds/empty.world"). For a missing path the .xml of
/// the same base name is taken, beside it or in one of `folders`. An empty name gives an empty
/// path: the empty world.
/// @throws std::runtime_error with a sentence if there is none.
std::string findWorldFile(const std::string& name, const std::vector<std::string>& folders);

}  // namespace franka_sim_mujoco
