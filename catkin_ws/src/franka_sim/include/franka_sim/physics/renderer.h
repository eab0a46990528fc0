// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_lights.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim {

/// A camera that looks from one point to another, both in the world frame [m].
struct Camera {
  std::array<double, 3> position{{1.4, -1.2, 1.2}};
  std::array<double, 3> target{{0, 0, 0.4}};
  double field_of_view{45};  ///< vertical [deg]
};

/// The data that drawing needs: captured by the stepping thread, drawn by another.
struct Scene {
  std::string mjcf;                      ///< World::mjcf(true)
  std::map<std::string, Pose> bodies;    ///< free bodies
  std::map<std::string, double> joints;  ///< joints with one degree of freedom [rad] or [m]
  std::vector<WorldLight> lights;  ///< all, in the order of the model, in their bodies' frames
  std::vector<Contact> contacts;   ///< for the window's arrows
  double time{0};                  ///< of the world [s]
  std::string fault;               ///< World::fault
};

struct Picture {
  int width{0}, height{0};
  std::vector<std::uint8_t> rgb;  ///< rows from top to bottom, 3 bytes a pixel
  std::vector<float> depth;  ///< distance along the viewing axis [m], as rgb; infinity: nothing
  Pose camera;               ///< pose of a named camera: optical frame (z ahead, y down)
};

/// Captures what `Renderer` needs from a world. The stepping thread calls it, between ticks; it
/// allocates.
Scene captureScene(World& world);

/// Draws scenes without a display, by EGL surfaceless or OSMesa, whichever the machine has. To save
/// memory the shadow map has at most 1024 texels a side, without multisampling (decision 38). Each
/// is used by one thread at a time; those of several threads wait for each other. What the caller's
/// thread draws with remains current in it. In a process that was forked after the first picture,
/// all functions but the destructor throw.
class Renderer {
 public:
  static constexpr int kMaxPictureSide = 4096;  ///< [pixel] per side, chosen here

  /// @throws std::runtime_error with a sentence when neither is available.
  Renderer();
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  /// @throws std::runtime_error with a sentence when the size, the camera or the scene cannot be
  /// drawn.
  Picture render(const Scene& scene, const Camera& camera, int width, int height);
  /// The view of a camera of the world, with depth. @throws as the other one, and when the scene
  /// has no such camera.
  Picture render(const Scene& scene, const std::string& camera, int width, int height);
  /// "EGL" or "OSMesa".
  std::string backend() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

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
