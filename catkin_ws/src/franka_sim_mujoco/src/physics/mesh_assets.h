// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/physics/world.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim_mujoco::physics {

/// A file MuJoCo can read, with its colour when the source has one.
struct MeshPart {
  std::string file;
  std::optional<std::array<double, 4>> rgba;
};

/// What to draw for a mesh URI: the file itself (binary STL, OBJ), or for a .dae the parts that the
/// mesh installer made of it (one OBJ per material, listed in
/// `meshes/mujoco/visual/<name>/index.yaml`). Empty when there is nothing MuJoCo can read: the
/// caller shows something simpler.
std::vector<MeshPart> visualParts(const std::string& uri, const ResourceResolver& resolve);

/// The file to collide with. @throws std::runtime_error with a sentence starting with `where` when
/// it cannot be found or is not a binary STL or OBJ.
std::string collisionFile(const std::string& uri, const ResourceResolver& resolve,
                          const std::string& where);

}  // namespace franka_sim_mujoco::physics
