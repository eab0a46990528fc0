// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/interface_resources.h>

#include <string>
#include <vector>

namespace hardware_interface {

/// Description of a controller for the robot.
struct ControllerInfo {
  std::string name;                                   ///< unique within its controller manager
  std::string type;                                   ///< plugin name
  std::vector<InterfaceResources> claimed_resources;  ///< by hardware interface
};

}  // namespace hardware_interface
