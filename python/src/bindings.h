// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>
#include <pyfranka/arrays.h>

#include <memory>

/// @file
/// The parts of the module.

namespace pyfranka {

void bindCalls(py::module_& module);
class Shared;

void bindExceptions(py::module_& module);
void bindNumbers(py::module_& module);
void bindState(py::module_& module);
void bindMotion(py::module_& module);
void bindRobot(py::module_& module);
void bindAsync(py::module_& module);
void bindGripper(py::module_& module);
void bindModel(py::module_& module);
void bindLimits(py::module_& module);

/// The parts of its submodule for simulations.
void bindSimState(py::module_& module);
void bindSimModel(py::module_& module);
void bindSimulation(py::module_& module);
void bindSimulatedRobot(py::module_& module,
                        py::class_<Shared, std::shared_ptr<Shared>>& simulation);
void bindWorld(py::class_<Shared, std::shared_ptr<Shared>>& simulation);
void bindBatch(py::module_& module);
void bindEpisode(py::module_& module);

}  // namespace pyfranka
