// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/line_server.h>
#include <franka_sim/fci/sim_robot.h>
#include <franka_sim/physics/world.h>

#include <atomic>
#include <string>
#include <vector>

namespace franka_sim {

/// The objects that the commands change; all of them outlive the server.
struct Scene {
  fci::SimRobot& robot;                       ///< the robot of this control interface
  std::string arm_id;                         ///< its prefix in the world
  const std::vector<fci::SimRobot*>& robots;  ///< all robots, including that one
  fci::Host& host;
  World& world;
  std::atomic<bool>& stop;
};

/// Adds the commands of the control interface (docs/franka_sim.md): buttons and switches of the
/// robot, the quality of its link, and changes of the world.
void addOperatorCommands(fci::LineServer& lines, const Scene& scene);

}  // namespace franka_sim
