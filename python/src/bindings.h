// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>
#include <pyfranka/arrays.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

/// @file
/// The parts of the module.

namespace franka {
class Robot;
}

namespace pyfranka {

class Shared;
class SimulatedRobotHandle;

void bindExceptions(py::module_& module);
void bindNumbers(py::module_& module);
void bindState(py::module_& module);
void bindMotion(py::module_& module);
void bindRobot(py::module_& module);
/// Its motions.
void bindControl(py::class_<franka::Robot>& robot);
void bindAsync(py::module_& module);
void bindGripper(py::module_& module);
void bindModel(py::module_& module);
void bindLimits(py::module_& module);

/// The parts of its submodule for simulations.
void bindSimState(py::module_& module);
void bindSimModel(py::module_& module);
/// @param refusal the exception of a robot on the network that refuses a command
void bindSimulation(py::module_& module, const py::object& refusal);
void bindSimulatedRobot(py::module_& module,
                        py::class_<Shared, std::shared_ptr<Shared>>& simulation);
/// Motions, laws and torques of its arm, and its hand.
void bindSimulatedCommands(py::class_<SimulatedRobotHandle>& robot);
void bindSimulatedHand(py::module_& module, py::class_<SimulatedRobotHandle>& robot);
void bindWorld(py::class_<Shared, std::shared_ptr<Shared>>& simulation);
void bindBatch(py::module_& module);
void bindEpisode(py::module_& module);

/// A __repr__ of the class and these attributes: "<VirtualWallCuboid: id 0, active False>".
inline auto shown(std::vector<const char*> attributes) {
  return [attributes = std::move(attributes)](const py::object& self) {
    std::string text = "<" + py::type::of(self).attr("__name__").cast<std::string>();
    const char* separator = ": ";
    for (const char* name : attributes) {
      text += separator + (name + (" " + py::str(self.attr(name)).cast<std::string>()));
      separator = ", ";
    }
    return text + ">";
  };
}

/// The answer of a comparison with another class, which Python then asks.
inline py::object notImplemented() { return py::reinterpret_borrow<py::object>(Py_NotImplemented); }

/// Lets pickle and copy raise TypeError with a sentence that says what to do instead.
template <typename Class>
void refuseCopies(Class& type, const char* sentence) {
  type.def(
      "__reduce__",
      [sentence](const py::object& /* self */) -> py::object { throw py::type_error(sentence); },
      "Raises TypeError.");
}

}  // namespace pyfranka
