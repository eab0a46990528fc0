// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_model_interface.h>
#include <pybind11/pybind11.h>

#include <memory>

#include "model_gate.h"

namespace franka_example_controllers {

/// The model as a Python object with the functions of franka_hw::FrankaModelHandle. It works only
/// while the gate is open and raises RuntimeError otherwise. With the interpreter's lock.
pybind11::object makeScriptModel(const franka_hw::FrankaModelHandle& handle,
                                 std::shared_ptr<ModelGate> gate);

}  // namespace franka_example_controllers
