// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/line_server.h>
#include <franka_sim/robot/whole_robot.h>

namespace franka_sim {

/// Adds the line `hand` (docs/franka_sim.md): commands of the Franka hand.
/// @param robot with any tool; it outlives the server
void addHandCommands(fci::LineServer& lines, WholeRobot& robot);

}  // namespace franka_sim
