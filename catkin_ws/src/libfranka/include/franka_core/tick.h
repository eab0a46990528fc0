// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_core {

/// The robot's cycle [s] (protocol 5.3).
constexpr double kTick = 1e-3;

}  // namespace franka_core
