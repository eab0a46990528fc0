// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/sim_robot.h>

#include "serve/json_writer.h"

namespace franka_sim::fci {

/// Writes members of an object: everything that an operator can see of the robot. Names and units:
/// docs/franka_sim.md. Not real-time safe.
void writeReport(SimRobot& robot, JsonWriter& json);

}  // namespace franka_sim::fci
