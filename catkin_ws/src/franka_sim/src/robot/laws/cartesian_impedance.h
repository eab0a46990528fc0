// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "robot/transforms.h"

namespace franka_sim {

/// Input of the Cartesian impedance law in one tick.
struct CartesianImpedanceInput {
  Transform O_T_EE_d, O_T_EE;           ///< desired and measured, 4x4 column-major
  Transform EE_T_K;                     ///< of the stiffness frame
  std::array<double, 6> O_dP_EE_d;      ///< desired twist of EE in O [m/s, rad/s]
  std::array<double, 42> O_J_EE;        ///< zero Jacobian of EE, 6x7 column-major
  std::array<double, 49> mass;          ///< without rotors, 7x7 column-major [kg m^2]
  std::array<double, 7> q_d, q, dq;     ///< [rad], [rad/s]; q_d is the null space's target
  std::array<double, 7> coriolis;       ///< C(q, dq) dq [Nm]
  std::array<double, 6> K;              ///< stiffness [N/m, Nm/rad], 0 or more
  double nullspace_stiffness{10.0};     ///< [Nm/rad], chosen here (decision 11)
  std::array<double, 7> rotor_inertia;  ///< B [kg m^2]
};

/// The unit's Cartesian impedance law (decision 11): springs and dampers between the desired and
/// the measured stiffness frame, along and about the axes of the measured one; a soft, critically
/// damped spring holds the joints' null space; Coriolis torques are added.
/// D_i = kDampingFactor sqrt(K_i / (J (M + B)^-1 J^T)_ii). The rotation error is a rotation vector.
/// Real-time safe. @returns torques without gravity [Nm]
std::array<double, 7> cartesianImpedance(const CartesianImpedanceInput& input) noexcept;

}  // namespace franka_sim
