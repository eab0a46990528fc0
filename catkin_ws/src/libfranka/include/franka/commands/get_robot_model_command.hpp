// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// The answer to the command that asks a robot for its description.

namespace franka {

/// What Robot::getRobotModel receives.
struct GetRobotModelResult {
  std::string robot_model_urdf;  ///< the URDF text
};

}  // namespace franka
