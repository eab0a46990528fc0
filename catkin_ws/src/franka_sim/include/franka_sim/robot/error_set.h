// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_error.h>

#include <array>
#include <cstddef>

namespace franka_sim {

/// The errors of one tick. Every rule that is violated adds its own (decision 47). Real-time safe.
class ErrorSet {
 public:
  ErrorSet() noexcept = default;
  // NOLINTNEXTLINE(google-explicit-constructor): one error is a set of one
  ErrorSet(franka_core::RobotError error) noexcept { add(error); }

  void add(franka_core::RobotError error) noexcept { flags_[franka_core::indexOf(error)] = true; }
  /// Adds the error if a rule is violated.
  void addIf(bool violated, franka_core::RobotError error) noexcept {
    flags_[franka_core::indexOf(error)] |= violated;
  }
  void add(const ErrorSet& others) noexcept { others.addTo(flags_); }
  /// Sets the flags of these errors in the order of the wire; the others stay.
  void addTo(std::array<bool, franka_core::kErrorCount>& flags) const noexcept {
    for (std::size_t i = 0; i < flags.size(); i++) {
      flags[i] |= flags_[i];
    }
  }

  explicit operator bool() const noexcept { return flags_ != Flags{}; }
  friend bool operator==(const ErrorSet& a, const ErrorSet& b) noexcept {
    return a.flags_ == b.flags_;
  }

 private:
  using Flags = std::array<bool, franka_core::kErrorCount>;
  Flags flags_{};
};

}  // namespace franka_sim
