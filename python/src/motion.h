// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control_base.h>
#include <franka/exception.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <utility>

namespace pyfranka {

/// A motion that can be ended before Python deletes it.
class Motion {
 public:
  explicit Motion(std::unique_ptr<franka::ActiveControlBase> motion) : motion_(std::move(motion)) {}
  Motion(Motion&&) = default;
  ~Motion() {
    // Called with the interpreter's lock held, and braking takes time.
    if (motion_) {
      const pybind11::gil_scoped_release release;
      motion_.reset();
    }
  }

  /// @throws franka::InvalidOperationException after close
  franka::ActiveControlBase& get() {
    if (!motion_) {
      throw franka::InvalidOperationException("This motion has been closed; start another one.");
    }
    return *motion_;
  }
  void close() noexcept { motion_.reset(); }

 private:
  std::unique_ptr<franka::ActiveControlBase> motion_;
};

}  // namespace pyfranka
