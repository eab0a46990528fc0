// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_hw/control_mode.h>
#include <franka_hw/franka_model_interface.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "arm_commander.h"
#include "model_gate.h"
#include "script_source.h"

namespace franka_example_controllers {

/// An instance of a script's class. All functions need the interpreter's lock; errors of the script
/// are pybind11::error_already_set, those of its use std::runtime_error with a sentence.
class Script {
 public:
  /// Runs the file or imports the module, and creates the instance. A file is run again each time.
  Script(const ScriptSource& source, const franka_hw::FrankaModelHandle& model,
         std::shared_ptr<ModelGate> gate);

  void starting(const franka::RobotState& state);
  /// @param period since the last cycle [s]
  ArmCommand update(const franka::RobotState& state, double period);
  /// Calls the script's `stopping` if it has one.
  void stopping();

 private:
  /// A copy for Python. The type is local to pyfranka's module: only that one makes its objects.
  pybind11::object copyOf(const franka::RobotState& state) const;
  ArmCommand commandOf(const pybind11::object& answer) const;
  void readPart(const std::string& name, const pybind11::object& value, ArmCommand& command) const;

  const franka_hw::ControlMode mode_;
  pybind11::object state_type_;
  pybind11::object model_;
  pybind11::object object_;
  pybind11::object update_;  // bound method
};

}  // namespace franka_example_controllers
