// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace franka_sim::physics {

/// An OpenGL context without a window. One thread at a time. In a process that was forked after the
/// first context was made it must not be used, nor destroyed: graphics drivers have threads, which
/// a forked process does not have, and would wait for them for ever.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// @throws std::runtime_error when the driver refuses, as while it is current in another thread.
  virtual void makeCurrent() = 0;
  /// Call in the thread in which it is current: then another thread may make it so.
  virtual void release() noexcept = 0;
  virtual std::string name() const = 0;
};

/// EGL surfaceless, else OSMesa. The environment variable FRANKA_SIM_RENDERER (egl or osmesa)
/// selects one of them. Both libraries are loaded here and not linked, so that a simulation without
/// pictures has no graphics driver in its memory.
/// @throws std::runtime_error with the reason why neither works and the package to install, and as
/// requireGlProcess
std::unique_ptr<GlContext> makeGlContext();

/// Whether this process may use contexts: it is the one that made the first, or there is none yet.
/// Thread-safe.
bool isGlProcess() noexcept;
/// @throws std::runtime_error with a sentence if it may not
void requireGlProcess();

}  // namespace franka_sim::physics
