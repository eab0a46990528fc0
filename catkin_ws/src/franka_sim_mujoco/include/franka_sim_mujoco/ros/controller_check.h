// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/controller_info.h>

#include <list>
#include <string>

namespace franka_sim_mujoco {

/// Why a controller cannot run on a simulated arm, as a sentence; empty when it can: it claims
/// nothing, the efforts of exactly the arm's seven joints, or the efforts of exactly its two
/// fingers.
std::string whyRefused(const hardware_interface::ControllerInfo& controller,
                       const std::string& arm_id);

/// Whether a controller commands joints of the arm (not its fingers). Real-time safe.
bool commandsArm(const hardware_interface::ControllerInfo& controller,
                 const std::string& arm_id) noexcept;

/// Whether one of them does. Real-time safe.
bool anyCommandsArm(const std::list<hardware_interface::ControllerInfo>& controllers,
                    const std::string& arm_id) noexcept;

}  // namespace franka_sim_mujoco
