// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/operator_commands.h>

#include <stdexcept>

#include "serve/commands/command_groups.h"

namespace franka_sim {

void addOperatorCommands(fci::CommandTable& table, const OperatorContext& context) {
  addSafetyCommands(table, context);
  addErrorCommands(table, context);
  addRobotCommands(table, context);
  addStateCommands(table, context);
  addHandCommands(table, context);
  addVacuumCommands(table, context);
  addLinkCommands(table, context);
  addWorldCommands(table, context);
}

void resetWorld(World& world, const std::vector<fci::SimRobot*>& robots, fci::Host& host) {
  for (const fci::SimRobot* robot : robots) {
    if (robot->expectsCommand()) {
      throw std::invalid_argument("A motion runs; the world is reset between motions only.");
    }
  }
  world.reset();
  for (fci::SimRobot* robot : robots) {
    robot->restart();
    robot->observe();  // the measurement of this tick is not valid any more
  }
  host.restartAfterReset();
}

}  // namespace franka_sim
