// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// What the unit adds to overcome the joints' friction [Nm]: Coulomb and viscous, where a joint
/// moves faster than 0.01 rad/s (decision 1). Real-time safe.
/// @param coulomb [Nm] @param viscous [Nm s/rad] @param dq [rad/s]
std::array<double, 7> frictionCompensation(const std::array<double, 7>& coulomb,
                                           const std::array<double, 7>& viscous,
                                           const std::array<double, 7>& dq) noexcept;

}  // namespace franka_sim
