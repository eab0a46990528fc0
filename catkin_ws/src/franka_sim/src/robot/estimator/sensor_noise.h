// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/sensor_physics.h>

#include <array>
#include <cstdint>
#include <random>

namespace franka_sim {

/// White noise and resolution of the readings of torque and velocity that the robot reports, and
/// the ripple of tau_J in motion: a sine, whose amplitude grows with the speed up to 0.05 rad/s.
/// The robot's own loops use the signals without them: how it filters those is not published.
/// Called by one thread. Real-time safe.
class SensorNoise {
 public:
  explicit SensorNoise(const SensorPhysics& physics) noexcept;

  /// Measured torques with noise, ripple and resolution [Nm]. @param dq measured [rad/s]
  std::array<double, 7> torques(const std::array<double, 7>& tau_J,
                                const std::array<double, 7>& dq) noexcept;
  /// Measured velocities with noise [rad/s].
  std::array<double, 7> velocities(const std::array<double, 7>& dq) noexcept;
  /// Repeats the same noise from the start.
  void restart() noexcept;

 private:
  std::array<double, 7> noisy(std::array<double, 7> values,
                              const std::array<double, 7>& deviation) noexcept;

  SensorPhysics physics_;
  bool noisy_torque_, noisy_velocity_;
  std::uint64_t ticks_{0};
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace franka_sim
