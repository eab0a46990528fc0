// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>

#include <memory>
#include <string>

namespace franka_sim {

/// A window that shows the world. Left button turns, right button shifts, the wheel zooms; C shows
/// contact points and forces, F the frames of the bodies, T makes everything translucent. One
/// thread owns a window and a process has one.
class Window {
 public:
  /// @throws std::runtime_error with a sentence without a display or without OpenGL on it
  explicit Window(const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Draws a scene and handles mouse and keyboard input.
  /// @returns false when the user has closed the window
  /// @throws std::runtime_error with a sentence when the scene does not compile
  bool draw(const Scene& scene);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace franka_sim
