// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <cstdint>

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

}  // namespace franka_sim
