// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/scene.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim {

/// A force on a point of a body, both in the world frame.
struct BodyPush {
  std::string body;
  std::array<double, 3> point;  ///< [m]
  std::array<double, 3> force;  ///< [N]
};

/// A window that shows the world. Left button turns, right button shifts, the wheel zooms; with
/// Ctrl the left button pushes a body. C shows contact points and forces, F the frames of the
/// bodies, T makes everything translucent, R turns the view back, H shows all this. One thread owns
/// a window and a process has one.
class Window {
 public:
  /// @throws std::runtime_error with a sentence without a display or without OpenGL on it
  explicit Window(const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Draws a scene and handles mouse and keyboard input.
  /// @param lines in the upper left corner, below the time: modes and errors of the robots
  /// @returns false when the user has closed the window
  /// @throws std::runtime_error with a sentence when the scene does not compile
  bool draw(const Scene& scene, const std::vector<std::string>& lines = {});

  /// The body that the user pushes with the mouse, as of the last picture.
  std::optional<BodyPush> push() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Lets the pushes of a window act in a world: for as many ticks as passed since the picture
/// before, so that the impulse is that of the force.
class PushByMouse {
 public:
  /// Call for each picture, between ticks. Does nothing while the world stands still.
  void act(World& world, const std::optional<BodyPush>& push);

 private:
  std::uint64_t ticks_{0};
};

}  // namespace franka_sim
