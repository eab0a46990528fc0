// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace franka_sim::physics {

/// An OpenGL context without a window. One thread owns it.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// @throws std::runtime_error when the driver refuses.
  virtual void makeCurrent() = 0;
  virtual std::string name() const = 0;
};

/// EGL surfaceless, else OSMesa. The environment variable FRANKA_SIM_RENDERER (egl or osmesa)
/// selects one of them. Both libraries are loaded here and not linked, so that a simulation without
/// pictures has no graphics driver in its memory.
/// @throws std::runtime_error with the reason why neither works and the package to
/// install.
std::unique_ptr<GlContext> makeGlContext();

}  // namespace franka_sim::physics
