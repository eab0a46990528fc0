// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// The reply to the request for the robot's description.

namespace franka {

/// Result of Robot::getRobotModel.
struct GetRobotModelResult {
  std::string robot_model_urdf;  ///< the URDF text
};

}  // namespace franka
