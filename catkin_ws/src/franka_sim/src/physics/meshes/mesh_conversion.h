// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// A file MuJoCo can read, with its color when the source has one.
struct MeshPart {
  std::string file;
  std::optional<std::array<double, 4>> rgba;
};

/// Selects a part of a mesh file.
struct MeshSource {
  std::string file;  ///< path
  Eigen::Vector3d scale{Eigen::Vector3d::Ones()};
  std::string submesh;  ///< empty: all of it
  bool center{false};   ///< centers its bounding box at the origin
};

/// A mesh to draw.
struct DrawnMesh {
  std::vector<MeshPart> parts;  ///< one per color
  bool is_textured{false};      ///< pictures on it are ignored
};

/// A mesh to collide with.
struct SolidMesh {
  std::string file;
  bool is_convex{true};  ///< else its convex hull collides
};

/// A mesh file of any format assimp knows, converted for MuJoCo and kept in memory (registerFile);
/// an unchanged file is read once. Thread-safe.
/// @throws std::runtime_error with the file and the error.
DrawnMesh loadMeshToDraw(const MeshSource& source);
/// The same for collisions: the outermost points of all colors, of which MuJoCo takes the hull. A
/// flat mesh gets a volume behind its front.
/// @throws std::runtime_error also when the mesh has almost no extent.
SolidMesh loadMeshToCollide(const MeshSource& source);

}  // namespace franka_sim::physics
