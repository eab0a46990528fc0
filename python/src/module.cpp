// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/extensions.h>

#include "bindings.h"

namespace {

/// The name of a module while its parts are bound, which is that of their classes and of their
/// types in docstrings and errors: the one that users import. Imported without pyfranka, the module
/// has its own name, of which its type stubs are made.
class PublicName {
 public:
  PublicName(const pybind11::module_& module, const char* name)
      : module_(module), own_(module.attr("__name__")) {
    const pybind11::dict loaded = pybind11::module_::import("sys").attr("modules");
    if (!loaded.attr("get")("pyfranka").is_none()) {
      module_.attr("__name__") = name;
    }
  }
  ~PublicName() {
    if (PyObject_SetAttrString(module_.ptr(), "__name__", own_.ptr()) != 0) {
      PyErr_Clear();  // a destructor must not throw
    }
  }

  PublicName(const PublicName&) = delete;
  PublicName& operator=(const PublicName&) = delete;

 private:
  pybind11::module_ module_;
  pybind11::object own_;
};

void bindClient(pybind11::module_& module) {
  const PublicName name(module, "pyfranka");
  pyfranka::bindExceptions(module);
  pyfranka::bindNumbers(module);
  pyfranka::bindState(module);
  pyfranka::bindModel(module);
  pyfranka::bindLimits(module);
  pyfranka::bindMotion(module);
  pyfranka::bindRobot(module);
  pyfranka::bindAsync(module);
  pyfranka::bindGripper(module);
}

void bindSimulations(pybind11::module_& module, const pybind11::object& refusal) {
  const PublicName name(module, "pyfranka.sim");
  pyfranka::bindSimState(module);
  pyfranka::bindSimModel(module);
  pyfranka::bindSimulation(module, refusal);
}

}  // namespace

PYBIND11_MODULE(_pyfranka, module) {
  module.doc() = "libfranka and ModelKDL; import pyfranka instead.";
  // multiprocessing forks, and two processes that use one connection receive each other's replies.
  franka::allowUseAfterFork(false);
  bindClient(module);
  pybind11::module_ sim = module.def_submodule("_sim", "Simulations; import pyfranka.sim instead.");
  sim.attr("Duration") = module.attr("Duration");  // which signatures show
  bindSimulations(sim, module.attr("CommandException"));
}
