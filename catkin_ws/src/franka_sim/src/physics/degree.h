// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim::physics {

constexpr double kDegree = 3.14159265358979323846 / 180;  ///< [rad]

}  // namespace franka_sim::physics
