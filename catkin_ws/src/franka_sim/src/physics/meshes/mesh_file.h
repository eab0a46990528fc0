// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "physics/meshes/triangle_mesh.h"

namespace franka_sim::physics {

/// The surfaces of a mesh file.
struct MeshFile {
  std::vector<TriangleMesh> parts;  ///< one per color, at least one
  bool is_textured{false};          ///< colors come from pictures, which are not drawn
};

/// Reads a mesh file by Debian's assimp (Collada, STL, OBJ and most others), as Gazebo and rviz do:
/// transforms of nodes are applied, Collada's <unit> counts and its <up_axis> does not; numbers in
/// other formats are meters. May take seconds for large files. Thread-safe.
/// @param submesh when not empty, only the nodes or geometries of this name
/// @param center puts the middle of the bounding box at the origin
/// @throws std::runtime_error with the file and the error.
MeshFile readMeshFile(const std::string& file, const std::string& submesh = "",
                      bool center = false);

}  // namespace franka_sim::physics
