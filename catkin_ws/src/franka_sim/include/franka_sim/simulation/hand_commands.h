// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/line_server.h>
#include <franka_sim/robot/gripper_unit.h>

namespace franka_sim {

/// Adds the line `hand` (docs/franka_sim.md): commands of the Franka hand, as its client gives
/// them.
/// @param hand null if the robot has another tool or none; it outlives the server
void addHandCommands(fci::LineServer& lines, GripperUnit* hand);

}  // namespace franka_sim
