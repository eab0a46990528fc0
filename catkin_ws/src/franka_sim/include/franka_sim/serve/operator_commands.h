// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/serve/command_table.h>
#include <franka_sim/serve/host.h>
#include <franka_sim/serve/scene_text.h>
#include <franka_sim/serve/sim_robot.h>

#include <functional>
#include <string>
#include <vector>

namespace franka_sim {

/// The objects that the commands of one robot's control interface change; all outlive the table.
struct OperatorContext {
  fci::SimRobot& robot;  ///< at whose address the line came
  std::string arm_id;    ///< the robot's prefix in the world
  fci::Host& host;       ///< of all robots
  World& world;          ///< of all robots
  SceneText& scene;      ///< of the world
  /// Sets the world and all robots to their initial state.
  /// @throws std::exception with a sentence, such as within a motion
  std::function<void()> reset;
  std::function<void()> quit;  ///< ends the program
};

/// Adds the commands of the control interface (docs/franka_sim.md): buttons and switches of the
/// robot, its safety controller and hand, the quality of its link, and changes of the world.
void addOperatorCommands(fci::CommandTable& table, const OperatorContext& context);

/// The line `reset` of a world in which all robots are served.
/// @throws std::invalid_argument with a sentence if a motion runs
void resetWorld(World& world, const std::vector<fci::SimRobot*>& robots, fci::Host& host);

}  // namespace franka_sim
