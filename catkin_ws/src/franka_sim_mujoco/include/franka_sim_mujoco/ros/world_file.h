// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Finds the MJCF file of a world as users name it: a path to an .xml, the name of a world in one
/// of `folders` ("stone", "worlds/empty.world"), or a path to a Gazebo world (.sdf, .world), in
/// whose place the .xml of the same base name stands, beside it or in one of `folders`. An empty
/// name gives an empty path: the empty world.
/// @throws std::runtime_error with a sentence when there is none.
std::string findWorldFile(const std::string& name, const std::vector<std::string>& folders);

}  // namespace franka_sim_mujoco
