// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/extensions.h>

#include "bindings.h"

PYBIND11_MODULE(_pyfranka, module) {
  module.doc() = "libfranka and ModelKDL; import pyfranka instead.";
  // multiprocessing forks, and two processes that use one connection receive each other's replies.
  franka::allowUseAfterFork(false);
  pyfranka::bindCalls(module);
  pyfranka::bindExceptions(module);
  pyfranka::bindNumbers(module);
  pyfranka::bindState(module);
  pyfranka::bindModel(module);
  pyfranka::bindLimits(module);
  pyfranka::bindMotion(module);
  pyfranka::bindRobot(module);
  pyfranka::bindAsync(module);
  pyfranka::bindGripper(module);

  pybind11::module_ sim = module.def_submodule("_sim", "Simulations; import pyfranka.sim instead.");
  pyfranka::bindSimState(sim);
  pyfranka::bindSimModel(sim);
  pyfranka::bindSimulation(sim, module.attr("CommandException"));
}
