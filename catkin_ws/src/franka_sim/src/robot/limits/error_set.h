// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_error.h>

#include <array>
#include <bitset>
#include <cstddef>

namespace franka_sim {

/// The errors of one tick. Every rule that is violated adds its own (decision 47). Real-time safe.
class ErrorSet {
 public:
  ErrorSet() noexcept = default;
  // NOLINTNEXTLINE(google-explicit-constructor): one error is a set of one
  ErrorSet(franka_core::RobotError error) noexcept { add(error); }

  void add(franka_core::RobotError error) noexcept { addIf(true, error); }
  void add(const ErrorSet& others) noexcept { flags_ |= others.flags_; }
  /// Adds the error if a rule is violated.
  void addIf(bool violated, franka_core::RobotError error) noexcept {
    flags_[franka_core::indexOf(error)] = violated || flags_[franka_core::indexOf(error)];
  }
  /// Sets the flags of these errors in the order of the wire; the others stay.
  void addTo(std::array<bool, franka_core::kErrorCount>& flags) const noexcept {
    if (flags_.any()) {
      for (std::size_t i = 0; i < flags.size(); i++) {
        flags[i] = flags[i] || flags_[i];
      }
    }
  }

  explicit operator bool() const noexcept { return flags_.any(); }
  friend bool operator==(const ErrorSet& a, const ErrorSet& b) noexcept {
    return a.flags_ == b.flags_;
  }

 private:
  std::bitset<franka_core::kErrorCount> flags_;
};

}  // namespace franka_sim
