// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// The robot's cycle [s] (protocol 5.3).
constexpr double kTick = 1e-3;

/// Cutoff of the unit's own signal filters [Hz] (decisions 2, 3).
constexpr double kSignalCutoff = 100.0;

}  // namespace franka_sim
