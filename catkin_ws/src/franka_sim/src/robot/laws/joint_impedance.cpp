// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/joint_impedance.h"

#include <cmath>
#include <cstddef>

#include "robot/laws/damping_factor.h"

namespace franka_sim {

std::array<double, 7> JointImpedance::torque(const std::array<double, 7>& q_d,
                                             const std::array<double, 7>& dq_d,
                                             const std::array<double, 7>& q,
                                             const std::array<double, 7>& dq,
                                             const std::array<double, 49>& mass,
                                             const std::array<double, 7>& coriolis) const noexcept {
  std::array<double, 7> tau;
  for (std::size_t i = 0; i < 7; i++) {
    const double inertia = mass[8 * i] + rotor_inertia_[i];
    const double damping = kDampingFactor * std::sqrt(stiffness_[i] * inertia);
    tau[i] = stiffness_[i] * (q_d[i] - q[i]) + damping * (dq_d[i] - dq[i]) + coriolis[i];
  }
  return tau;
}

}  // namespace franka_sim
