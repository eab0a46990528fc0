// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

#include <stdexcept>
#include <string>

namespace franka_sim::physics {

/// A library for pictures, which the machine may lack: loaded when it is needed, and never
/// unloaded, because drivers leave threads and handlers behind. Thread-safe.
class RunTimeLibrary {
 public:
  /// @throws std::runtime_error if the machine does not have it
  explicit RunTimeLibrary(const char* name) : handle_(dlopen(name, RTLD_NOW | RTLD_GLOBAL)) {
    if (handle_ == nullptr) {
      throw std::runtime_error(std::string(name) + " cannot be loaded");
    }
  }

  /// @throws std::runtime_error if the library has no such function
  template <typename Function>
  Function find(const char* name) const {
    auto function = reinterpret_cast<Function>(dlsym(handle_, name));
    if (function == nullptr) {
      throw std::runtime_error(std::string(name) + " is missing in the library");
    }
    return function;
  }

 private:
  void* handle_;
};

}  // namespace franka_sim::physics
