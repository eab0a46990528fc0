// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>

namespace franka_sim::physics {

/// An OpenGL context without a window. In a process that was forked after the
/// first context was made it must not be used, nor destroyed: graphics drivers have threads, which
/// a forked process does not have, and would wait for them for ever.
class GlContext {
 public:
  virtual ~GlContext() = default;
  virtual std::string name() const = 0;

 protected:
  friend class CurrentContext;
  /// @throws std::runtime_error when the driver refuses
  virtual void makeCurrent() = 0;
  /// Makes current again what was so before.
  virtual void release() noexcept = 0;
};

/// Makes a context current in this thread for its life, and then what was current before. Threads
/// wait for each other. Thread-safe.
class CurrentContext {
 public:
  /// @throws std::runtime_error as requireGlProcess, and when the driver refuses
  explicit CurrentContext(GlContext& context);
  ~CurrentContext();
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  std::unique_lock<std::mutex> lock_;
  GlContext& context_;
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
