// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace franka_sim::physics {

/// What MuJoCo cannot do: too little memory for its stack, data of another model, no graphics.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Installs the handlers of MuJoCo's errors and warnings, once in a process. MuJoCo's own handler
/// of errors prints, waits for the Enter key and ends the process. A handler that the program has
/// installed already stays.
void installEngineHandlers() noexcept;

/// Within its life, an error of MuJoCo in this thread throws EngineError out of the function of
/// MuJoCo, whose results are then not usable. Without one, an error prints its sentence and aborts
/// the process. May be nested. Real-time safe. Exception: an error.
class EngineErrorScope {
 public:
  EngineErrorScope() noexcept;
  ~EngineErrorScope();
  EngineErrorScope(const EngineErrorScope&) = delete;
  EngineErrorScope& operator=(const EngineErrorScope&) = delete;
};

}  // namespace franka_sim::physics
