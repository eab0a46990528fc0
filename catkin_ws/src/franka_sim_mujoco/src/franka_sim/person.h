// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/fci/line_server.h>
#include <franka_sim_mujoco/fci/sim_robot.h>
#include <franka_sim_mujoco/physics/world.h>

#include <atomic>

namespace franka_sim_mujoco {

/// Enters the commands of the control interface (see docs of franka_sim): buttons and switches of
/// the robot, the quality of its link, and what hands do to the world. All references outlive the
/// server.
void addPersonCommands(fci::LineServer& lines, fci::SimRobot& robot, fci::Host& host, World& world,
                       std::atomic<bool>& stop);

}  // namespace franka_sim_mujoco
