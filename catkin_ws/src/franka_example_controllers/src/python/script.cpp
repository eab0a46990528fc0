// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "script.h"

#include <franka_core/transform.h>
#include <franka_example_controllers/command_claims.h>
#include <pyfranka/arrays.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "script_model.h"

namespace franka_example_controllers {

namespace {

namespace py = pybind11;
using franka_hw::ControlMode;

py::object pythonOf(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return py::bool_(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return py::int_(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return py::float_(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return py::str(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      py::list list;
      for (int i = 0; i < value.size(); ++i) {
        list.append(pythonOf(value[i]));
      }
      return py::object(list);
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      py::dict dict;
      for (auto& [name, member] : value) {
        dict[py::str(name)] = pythonOf(member);
      }
      return py::object(dict);
    }
    default:
      return py::none();
  }
}

/// Runs a file as a private module; always the file itself, never a compiled copy.
py::object moduleOfFile(const std::string& file) {
  const py::object loader = py::module_::import("importlib.machinery")
                                .attr("SourceFileLoader")("controller_script", file);
  const py::object code = loader.attr("source_to_code")(loader.attr("get_data")(file), file);
  py::object module = py::module_::import("types").attr("ModuleType")("controller_script");
  module.attr("__file__") = file;
  py::module_::import("builtins").attr("exec")(code, module.attr("__dict__"));
  return module;
}

py::object classIn(const py::object& module, const ScriptSource& source) {
  const std::string where = source.file.empty() ? source.module : source.file;
  if (!py::hasattr(module, source.class_name.c_str())) {
    throw std::runtime_error("'" + where + "' has no class '" + source.class_name +
                             "'; check the parameter class.");
  }
  py::object type = module.attr(source.class_name.c_str());
  for (const char* name : {"starting", "update"}) {
    if (!py::hasattr(type, name) || !PyCallable_Check(py::object(type.attr(name)).ptr())) {
      throw std::runtime_error("The class '" + source.class_name + "' of '" + where +
                               "' has no function '" + name +
                               "'; it needs starting(state, model) and update(state, model, "
                               "period).");
    }
  }
  return type;
}

/// An instance of a class, whose constructor may take the controller's parameters.
py::object objectOf(const py::object& type, const ScriptSource& source) {
  const py::object signature = py::module_::import("inspect").attr("signature")(type);
  if (py::len(signature.attr("parameters")) == 0) {
    return type();
  }
  XmlRpc::XmlRpcValue parameters = source.parameters;
  return type(pythonOf(parameters));
}

template <std::size_t size>
std::array<double, size> finite(const py::object& value, const std::string& name) {
  const std::array<double, size> values = pyfranka::arrayOf<size>(value, name.c_str());
  for (const double number : values) {
    if (!std::isfinite(number)) {
      throw std::runtime_error("The command " + name +
                               " holds a value that is not a finite number.");
    }
  }
  return values;
}

void checkPose(const std::array<double, 16>& pose) {
  const std::string fault = franka_core::transformFault(pose);
  if (!fault.empty()) {
    throw std::runtime_error("The command cartesian_pose is not a pose: " + fault + ".");
  }
}

std::string namesOf(ControlMode mode) {
  std::string names;
  const std::pair<ControlMode, const char*> all[] = {
      {ControlMode::JointPosition, "joint_position"},
      {ControlMode::JointVelocity, "joint_velocity"},
      {ControlMode::CartesianPose, "cartesian_pose"},
      {ControlMode::CartesianVelocity, "cartesian_velocity"},
      {ControlMode::JointTorque, "effort"}};
  for (const auto& [bit, name] : all) {
    if (commands(mode, bit)) {
      names += (names.empty() ? "" : " and ") + std::string(name);
    }
  }
  return names;
}

constexpr ControlMode kCartesian = ControlMode::CartesianPose | ControlMode::CartesianVelocity;

}  // namespace

Script::Script(const ScriptSource& source, const franka_hw::FrankaModelHandle& model,
               std::shared_ptr<ModelGate> gate)
    : mode_(source.mode) {
  state_type_ = py::module_::import("pyfranka").attr("RobotState");
  const py::object module = source.file.empty()
                                ? py::object(py::module_::import(source.module.c_str()))
                                : moduleOfFile(source.file);
  object_ = objectOf(classIn(module, source), source);
  update_ = object_.attr("update");
  model_ = makeScriptModel(model, std::move(gate));
}

void Script::starting(const franka::RobotState& state) {
  object_.attr("starting")(copyOf(state), model_);
}

ArmCommand Script::update(const franka::RobotState& state, double period) {
  return commandOf(update_(copyOf(state), model_, period));
}

void Script::stopping() {
  if (py::hasattr(object_, "stopping")) {
    object_.attr("stopping")();
  }
}

py::object Script::copyOf(const franka::RobotState& state) const {
  py::object copy = state_type_();
  copy.cast<franka::RobotState&>() = state;
  return copy;
}

ArmCommand Script::commandOf(const py::object& answer) const {
  ArmCommand command;
  if (answer.is_none()) {
    throw std::runtime_error("update() returned None; it must return " + namesOf(mode_) + ".");
  }
  if (!py::isinstance<py::dict>(answer)) {
    const std::string name = namesOf(mode_);
    if (name.find(' ') != std::string::npos) {
      throw std::runtime_error("update() must return a dict with " + name + ".");
    }
    readPart(name, answer, command);
    return command;
  }
  int missing = 0;
  for (ControlMode bit :
       {ControlMode::JointPosition, ControlMode::JointVelocity, ControlMode::CartesianPose,
        ControlMode::CartesianVelocity, ControlMode::JointTorque}) {
    missing += commands(mode_, bit) && !answer.contains(namesOf(bit).c_str()) ? 1 : 0;
  }
  if (missing > 0) {
    throw std::runtime_error("The dict that update() returned must hold " + namesOf(mode_) + ".");
  }
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(answer)) {
    readPart(py::str(name), py::reinterpret_borrow<py::object>(value), command);
  }
  return command;
}

void Script::readPart(const std::string& name, const py::object& value, ArmCommand& command) const {
  if ((name == "joint_position" && commands(mode_, ControlMode::JointPosition)) ||
      (name == "joint_velocity" && commands(mode_, ControlMode::JointVelocity))) {
    command.joints = finite<7>(value, name);
  } else if (name == "cartesian_pose" && commands(mode_, ControlMode::CartesianPose)) {
    command.pose = pyfranka::arrayOf<16>(value, name.c_str());
    checkPose(command.pose);
  } else if (name == "cartesian_velocity" && commands(mode_, ControlMode::CartesianVelocity)) {
    command.twist = finite<6>(value, name);
  } else if (name == "effort" && commands(mode_, ControlMode::JointTorque)) {
    command.effort = finite<7>(value, name);
  } else if (name == "elbow" && commands(mode_, kCartesian)) {
    command.elbow = finite<2>(value, name);
    if (std::abs(command.elbow[1]) != 1.0) {
      throw std::runtime_error(
          "The command elbow must hold the position of joint 3 [rad], and -1 or 1 for the side of "
          "joint 4.");
    }
  } else {
    throw std::runtime_error("update() returned '" + name + "', but this controller commands " +
                             namesOf(mode_) + ".");
  }
}

}  // namespace franka_example_controllers
