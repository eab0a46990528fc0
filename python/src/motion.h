// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control_base.h>
#include <franka/exception.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

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
      close();
    }
  }

  /// @throws franka::InvalidOperationException after close, and in a forked process
  franka::ActiveControlBase& get() {
    if (process_ != getpid()) {
      throw franka::InvalidOperationException(
          "This motion was started before the process was forked and belongs to the other "
          "process.");
    }
    if (!motion_) {
      throw franka::InvalidOperationException("This motion has been closed; start another one.");
    }
    return *motion_;
  }
  bool closed() const noexcept { return !motion_; }
  void close() noexcept {
    if (process_ == getpid()) {
      motion_.reset();
    } else {
      static_cast<void>(motion_.release());  // whose end would brake the robot of the other process
    }
  }

 private:
  pid_t process_ = getpid();
  std::unique_ptr<franka::ActiveControlBase> motion_;
};

}  // namespace pyfranka
