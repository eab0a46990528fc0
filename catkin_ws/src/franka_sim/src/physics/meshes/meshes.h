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

struct DrawnMesh {
  std::vector<MeshPart> parts;  ///< one per color
  bool is_textured{false};      ///< pictures on it are ignored
};

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
