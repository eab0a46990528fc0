// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>

#include <string>

namespace franka_sim {

/// One line for the user that describes a robot's mode and errors: `panda: Reflex,
/// cartesian_reflex`. Not real-time safe.
std::string conditionText(const std::string& name, const franka_core::RobotState& state);

}  // namespace franka_sim
