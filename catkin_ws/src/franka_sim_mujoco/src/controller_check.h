// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/control_mode.h>
#include <hardware_interface/controller_info.h>

#include <list>
#include <set>
#include <string>

namespace franka_sim_mujoco {

/// Why a controller cannot run on a simulated arm, as a sentence; empty if it can: it may claim
/// nothing; each joint interface on all seven of the arm's joints, or none; a Cartesian interface
/// on `<arm_id>_robot`; the efforts of both fingers; and any of the other joints.
/// @param others joints of the same robot that belong to no Franka arm
std::string whyRefused(const hardware_interface::ControllerInfo& controller,
                       const std::string& arm_id, const std::set<std::string>& others = {});

/// Whether controllers conflict: by the rules of franka_hw::FrankaHW for the arm; fingers and other
/// joints accept one controller each. Logs the reason.
bool conflict(const std::list<hardware_interface::ControllerInfo>& controllers,
              const std::string& arm_id);

/// Whether a controller commands the arm (fingers excluded). Real-time safe.
bool commandsArm(const hardware_interface::ControllerInfo& controller,
                 const std::string& arm_id) noexcept;

/// The arm's mode for the controllers' claims. Real-time safe.
franka_hw::ControlMode claimedMode(const std::list<hardware_interface::ControllerInfo>& controllers,
                                   const std::string& arm_id) noexcept;

}  // namespace franka_sim_mujoco
