// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>

namespace franka_sim_mujoco {

/// Commands of an arm's controllers, one field for each kind of hardware interface. The handles
/// write here; the claims determine which fields count.
struct ArmCommands {
  std::array<double, 7> torque{};                                ///< without gravity [Nm]
  std::array<double, 7> position{};                              ///< [rad]
  std::array<double, 7> velocity{};                              ///< [rad/s]
  std::array<double, 16> pose{franka_core::kIdentityTransform};  ///< O_T_EE, column-major [m]
  std::array<double, 2> pose_elbow{};   ///< (q3 [rad], sign of joint 4); (0, 0): free
  std::array<double, 6> twist{};        ///< O_dP_EE [m/s, rad/s]
  std::array<double, 2> twist_elbow{};  ///< likewise
};

}  // namespace franka_sim_mujoco
