// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim::physics {

/// A surface of triangles in one colour.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;      ///< [m]
  std::vector<std::array<int, 3>> faces;      ///< counter-clockwise seen from outside
  std::optional<std::array<double, 4>> rgba;  ///< when the file says one
};

/// Takes `added` into `mesh`, whose colour stays.
void append(const TriangleMesh& added, TriangleMesh* mesh);
/// Makes vertices at the same place one; drops faces that are none any more and vertices without a
/// face.
void tidy(TriangleMesh* mesh);
/// Stretches along the axes; negative numbers mirror, and outside stays outside.
void stretch(const Eigen::Vector3d& scale, TriangleMesh* mesh);
/// Gives a flat surface a back, `thickness` [m] behind its front, because MuJoCo has no hull for
/// what has no volume. Others stay as they are.
void thickenFlat(double thickness, TriangleMesh* mesh);

/// Lengths along the principal axes of the vertices, the shortest first [m].
Eigen::Vector3d extents(const TriangleMesh& mesh);
/// Whether the surface is that of its convex hull, within 1 % of its size. Of large meshes some of
/// the faces are looked at.
bool isConvex(const TriangleMesh& mesh);
/// Leaves the faces out, and of more than `most` vertices those that reach farthest in `most`
/// directions: enough for a hull, which MuJoCo finds in a time that grows with their square. Of a
/// ball 2000 miss 0.2 % of the radius.
void keepOutermost(int most, TriangleMesh* mesh);
/// In MuJoCo's own binary format (.msh), without normals and texture coordinates. Of one
/// without faces it takes the hull.
std::string toMsh(const TriangleMesh& mesh);

}  // namespace franka_sim::physics
