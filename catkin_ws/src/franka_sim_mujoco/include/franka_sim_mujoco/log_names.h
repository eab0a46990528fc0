// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim_mujoco {

// Names of loggers, for the macros ROS_*_NAMED.
constexpr char kLog[] = "franka_sim_mujoco";      ///< of the simulation
constexpr char kHardwareLog[] = "franka_hw_sim";  ///< of FrankaHWSim and its services

}  // namespace franka_sim_mujoco
