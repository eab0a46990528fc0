// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/robot/whole_robot.h>
#include <franka_sim/serve/line_server.h>
#include <franka_sim/serve/sim_robot.h>

#include <functional>
#include <string>
#include <vector>

namespace franka_sim {

/// The objects that the commands of one robot's control interface change; all outlive the server.
struct OperatorContext {
  fci::SimRobot& robot;  ///< at whose address the line came
  std::string arm_id;    ///< the robot's prefix in the world
  fci::Host& host;       ///< of all robots
  World& world;          ///< of all robots
  /// Sets the world and all robots to their initial state.
  /// @throws std::exception with a sentence, such as within a motion
  std::function<void()> reset;
  std::function<void()> quit;  ///< ends the program
};

/// Adds the commands of the control interface (docs/franka_sim.md): buttons and switches of the
/// robot, its safety controller and hand, the quality of its link, and changes of the world.
void addOperatorCommands(fci::LineServer& lines, const OperatorContext& context);

/// @name The switches of the operator
/// By the rules that the robot has (SafetyRules).
/// @throws std::runtime_error "CODE: Sentence." if a rule refuses it; setFci also when the port
/// cannot be opened
/// @{
void setUserStop(WholeRobot& robot, bool pressed);
void setGuiding(WholeRobot& robot, bool active);
void setBrakes(WholeRobot& robot, bool closed);
void setFci(fci::SimRobot& robot, bool active);
/// @}

/// The line `reset` of a world in which all robots are served.
/// @throws std::invalid_argument with a sentence if a motion runs
void resetWorld(World& world, const std::vector<fci::SimRobot*>& robots, fci::Host& host);

/// Adds the line `hand` (docs/franka_sim.md): commands of the Franka hand.
/// @param robot with any tool; it outlives the server
void addHandCommands(fci::LineServer& lines, WholeRobot& robot);

/// Adds the commands of the robot's safety controller: stops, brakes, FCI, operating mode, guiding,
/// self-test, errors, the end effector and motions by Desk; and the report of its state.
void addSafetyCommands(fci::LineServer& lines, const OperatorContext& context);

}  // namespace franka_sim
