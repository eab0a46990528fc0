// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace franka_sim {

/// Triangles of a mesh, in the frame of each shape that has it.
struct ShapeMesh {
  std::vector<float> vertices;       ///< x, y, z [m]
  std::vector<std::uint32_t> faces;  ///< three vertices each, counter-clockwise from outside
};

/// A shape to draw, fixed to a body.
struct Shape {
  enum class Kind { kPlane, kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh };

  std::size_t body{0};  ///< index in WorldShapes::bodies
  Kind kind{Kind::kBox};
  /// [m] Half sizes, as MuJoCo has them: box and ellipsoid x, y, z; sphere radius; capsule and
  /// cylinder radius, half length along z; plane half x, half y (0: endless). A mesh has none.
  std::array<double, 3> size{};
  Pose pose;                     ///< in the body
  std::array<float, 4> color{};  ///< red, green, blue, opacity, 0 to 1
  std::size_t mesh{0};           ///< of kMesh: index in WorldShapes::meshes
};

/// The shapes of a world as data, for programs that draw it themselves.
struct WorldShapes {
  /// All bodies, links included, and unnamed ones too; each once. The order is that of framePoses()
  /// (physics/world_bodies.h), as long as World::generation() is the same.
  std::vector<std::string> bodies;
  std::vector<Shape> shapes;
  std::vector<ShapeMesh> meshes;
};

/// Prepares reading what a renderer would draw of a world. The stepping thread calls it between
/// ticks; it allocates. The returned function reads meshes and compiles a model, which takes
/// seconds: any thread may call it, also after the world has changed or has been destroyed.
/// @throws std::runtime_error (the function does) with a sentence when the model does not compile
std::function<WorldShapes()> shapesOf(World& world);

}  // namespace franka_sim
