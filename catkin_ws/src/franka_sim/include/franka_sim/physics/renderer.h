// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/scene.h>
#include <franka_sim/physics/world.h>

#include <array>
#include <cstdint>
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

/// A drawn picture.
struct Picture {
  int width{0}, height{0};
  std::vector<std::uint8_t> rgb;  ///< rows from top to bottom, 3 bytes a pixel
  std::vector<float> depth;  ///< distance along the viewing axis [m], as rgb; infinity: nothing
  Pose camera;               ///< pose of a named camera: optical frame (z ahead, y down)
};

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

}  // namespace franka_sim
