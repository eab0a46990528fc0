// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/tick.h>

#include <array>
#include <cstdint>
#include <random>

namespace franka_sim {

/// Errors of the robot's sensors, joints 1 to 7 (docs/fidelity.md).
struct SensorPhysics {
  /// Of the first-order filter of tau_ext_hat_filtered [Hz].
  std::array<double, 7> tau_ext_cutoff{{kSignalCutoff, kSignalCutoff, kSignalCutoff, kSignalCutoff,
                                        kSignalCutoff, kSignalCutoff, kSignalCutoff}};
  std::array<double, 7> tau_J_resolution{};  ///< [Nm]; 0: continuous
  std::array<double, 7> tau_J_noise{};       ///< standard deviation before rounding [Nm]
  std::array<double, 7> dq_noise{};          ///< standard deviation [rad/s]
  std::array<double, 7> tau_J_ripple{};      ///< of the elastic gears in motion, RMS [Nm]
  std::array<double, 7> ripple_frequency{};  ///< [Hz]
  std::uint64_t seed{1};                     ///< of the noise
};

/// White noise and resolution of the readings of torque and velocity that the robot reports, and
/// the ripple of tau_J in motion: a sine, whose amplitude grows with the speed up to 0.05 rad/s.
/// The robot's own loops use the signals without them: how it filters those is not published.
/// Called by one thread. Real-time safe.
class SensorNoise {
 public:
  explicit SensorNoise(const SensorPhysics& physics) noexcept;

  /// @param dq measured [rad/s]
  std::array<double, 7> torques(const std::array<double, 7>& tau_J,
                                const std::array<double, 7>& dq) noexcept;
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
