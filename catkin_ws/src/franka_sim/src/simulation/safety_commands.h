// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/line_server.h>
#include <franka_sim/simulation/operator_commands.h>

namespace franka_sim {

/// Adds the commands of the robot's safety controller: stops, brakes, FCI, operating mode, guiding,
/// self-test, errors, the end effector and motions by Desk; and the report of its state.
void addSafetyCommands(fci::LineServer& lines, const OperatorContext& context);

}  // namespace franka_sim
