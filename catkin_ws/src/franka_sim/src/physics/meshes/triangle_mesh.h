// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// A triangle surface of one color.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;      ///< [m]
  std::vector<std::array<int, 3>> faces;      ///< counter-clockwise seen from outside
  std::optional<std::array<double, 4>> rgba;  ///< if the file has one
};

/// Adds `added` to `mesh`, whose color stays.
void append(const TriangleMesh& added, TriangleMesh* mesh);
/// Merges vertices at the same position; drops degenerate faces and vertices without a face.
void tidy(TriangleMesh* mesh);
/// Scales along the axes; negative factors mirror, with the outside kept outside.
void stretch(const Eigen::Vector3d& scale, TriangleMesh* mesh);
/// Gives a flat surface a back, `thickness` [m] behind its front, because MuJoCo has no hull
/// without volume. Other surfaces are unchanged.
void thickenFlat(double thickness, TriangleMesh* mesh);

/// Lengths along the principal axes of the vertices, the shortest first [m].
Eigen::Vector3d extents(const TriangleMesh& mesh);
/// Whether the surface is that of its convex hull, within 1 % of its size. Of large meshes only
/// some faces are checked.
bool isConvex(const TriangleMesh& mesh);
/// Removes the faces, and keeps of more than `most` vertices those that reach farthest in `most`
/// directions: enough for a hull, whose computing time in MuJoCo grows with their square. For a
/// ball, 2000 deviate by 0.2 % of the radius.
void keepOutermost(int most, TriangleMesh* mesh);
/// MuJoCo's own binary format (.msh), without normals and texture coordinates. For a mesh without
/// faces MuJoCo takes the hull.
std::string toMsh(const TriangleMesh& mesh);

}  // namespace franka_sim::physics
