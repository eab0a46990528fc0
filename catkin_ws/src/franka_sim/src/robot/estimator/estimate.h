// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>

namespace franka_sim {

/// Estimates from the measurements that are not part of the state.
struct Estimate {
  bool first{true};            ///< the first sample since the start or a restart
  bool measured{false};        ///< this sample continues a finite one: rates and torques are valid
  std::array<double, 7> dq{};  ///< without the noise of the reported one [rad/s]
  std::array<double, 7> tau_J{};        ///< likewise [Nm]
  franka_core::ArmDynamics dynamics{};  ///< of frame EE
  std::array<double, 7> tau_ext{};      ///< unfiltered [Nm]
  std::array<double, 6> wrench{};       ///< unfiltered, in the axes of the thresholds [N, Nm]
  std::array<double, 6> O_dP_EE{};      ///< measured twist of EE in O [m/s, rad/s]
};

}  // namespace franka_sim
