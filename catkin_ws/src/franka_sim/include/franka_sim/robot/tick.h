// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/tick.h>

namespace franka_sim {

using franka_core::kTick;

/// Cutoff of the control unit's own signal filters [Hz] (decisions 2, 3).
constexpr double kSignalCutoff = 100.0;

}  // namespace franka_sim
