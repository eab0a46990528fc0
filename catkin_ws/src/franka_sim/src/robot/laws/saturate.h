// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// Each torque saturated to the motor's range; values that are not finite become zero.
/// Real-time safe. @param limit [Nm]
std::array<double, 7> saturate(const std::array<double, 7>& tau,
                               const std::array<double, 7>& limit) noexcept;

}  // namespace franka_sim
