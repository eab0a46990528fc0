// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// Changes from one control law to the next without a torque step: the difference of the laws at
/// the switch is added and fades at the torque rate that the robot allows (protocol 5.5). Called by
/// one thread. Real-time safe.
class TorqueBlend {
 public:
  /// The law changes before the next `apply`.
  void lawChanges() noexcept { changing_ = true; }
  /// The same for a law that starts from zero: its torque acts at once.
  void lawStartsFromZero() noexcept {
    changing_ = false;
    offset_ = last_;
  }
  /// No torque acts (brakes closed): nothing to blend from.
  void restart() noexcept;

  /// @param tau of the present law [Nm] @returns the torque to apply [Nm]
  std::array<double, 7> apply(const std::array<double, 7>& tau) noexcept;

 private:
  bool changing_{false};
  std::array<double, 7> offset_{}, last_{};
};

}  // namespace franka_sim
