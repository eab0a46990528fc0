// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <string>
#include <vector>

#include "physics/meshes/mesh_conversion.h"

namespace franka_sim::physics {

/// Drawable parts of a robot's mesh URI: those of the mesh installer (one OBJ per material, listed
/// in `meshes/mujoco/visual/<name>/index.yaml`), the file itself (binary STL, OBJ), or the result
/// of `loadMeshToDraw`, which takes longer. Empty when it cannot be read: the caller draws
/// something simpler.
std::vector<MeshPart> visualParts(const std::string& uri, const ResourceResolver& resolve);

/// Collision file: the file itself (binary STL, OBJ) or the result of `loadMeshToCollide`. @throws
/// std::runtime_error with a sentence starting with `where` when it cannot be found or read.
std::string collisionFile(const std::string& uri, const ResourceResolver& resolve,
                          const std::string& where);

}  // namespace franka_sim::physics
