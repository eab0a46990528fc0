// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/control_mode.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

namespace franka_example_controllers {

/// Location of a script's class, and its command.
struct ScriptSource {
  std::string file;        ///< path of a Python file; if empty:
  std::string module;      ///< name of an importable module
  std::string class_name;  ///< of the class in it
  franka_hw::ControlMode mode;
  XmlRpc::XmlRpcValue parameters;  ///< of the controller's namespace, for the constructor
};

}  // namespace franka_example_controllers
