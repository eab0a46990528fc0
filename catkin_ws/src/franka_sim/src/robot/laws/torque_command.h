// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// The torque of external control: the last commanded one, saturated to the motors' range and held
/// while commands are missing (protocol 5.3). Called by one thread. Real-time safe.
class TorqueCommand {
 public:
  explicit TorqueCommand(const std::array<double, 7>& limit) noexcept : limit_(limit) {}

  /// @param tau without gravity [Nm]; ignored as a whole when any value is not finite
  /// @returns whether it was accepted.
  bool receive(const std::array<double, 7>& tau) noexcept;
  /// Whether `tau` is not finite, or a step to it exceeds the rate of 1000 Nm/s from both the last
  /// commanded and the last saturated torque; tolerance 0.01 Nm/s (decision 14).
  bool jumps(const std::array<double, 7>& tau) const noexcept;
  void clear() noexcept {
    tau_.fill(0.0);
    commanded_.fill(0.0);
  }
  const std::array<double, 7>& value() const noexcept { return tau_; }

 private:
  std::array<double, 7> limit_;
  std::array<double, 7> tau_{}, commanded_{};  // saturated, and as commanded
};

}  // namespace franka_sim
