// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// Joint impedance law (decision 10): a spring K to the desired position, a damper D_i =
/// kDampingFactor sqrt(K_i (M_ii + B_i)) to the desired velocity, and the Coriolis torques. A joint
/// without stiffness has no damping either. Called by one thread. Real-time safe.
class JointImpedance {
 public:
  /// @param stiffness K [Nm/rad] @param rotor_inertia B [kg m^2]
  JointImpedance(const std::array<double, 7>& stiffness,
                 const std::array<double, 7>& rotor_inertia) noexcept
      : stiffness_(stiffness), rotor_inertia_(rotor_inertia) {}

  /// @param mass M(q), 7x7 column-major, without B [kg m^2] @param coriolis C(q, dq) dq [Nm]
  /// @returns torques without gravity [Nm]
  std::array<double, 7> torque(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                               const std::array<double, 7>& q, const std::array<double, 7>& dq,
                               const std::array<double, 49>& mass,
                               const std::array<double, 7>& coriolis) const noexcept;

 private:
  std::array<double, 7> stiffness_;
  std::array<double, 7> rotor_inertia_;
};

}  // namespace franka_sim
