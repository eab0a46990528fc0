// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>

namespace franka_sim {

/// Whether three bounds are positive numbers, as Move requires.
bool isDeviation(const franka_core::fci::Deviation& deviation) noexcept;

/// Whether the measured end effector is farther from the desired one (O_T_EE_d) than allowed, or
/// the elbow from elbow_d. Real-time safe.
bool deviates(const franka_core::RobotState& state,
              const franka_core::fci::Deviation& allowed) noexcept;

}  // namespace franka_sim
