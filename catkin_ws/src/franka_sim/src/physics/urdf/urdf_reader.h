// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "physics/urdf/urdf_reader.h"
#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {

/// Reads a URDF text with tinyxml2, because urdfdom loses the order of the file (decision 59).
/// Joints without a range are held, and rounded inertias repaired: see `notes`.
/// @throws std::runtime_error that names the robot, the element and the error: XML errors,
/// duplicate names, unknown links, two roots or parents, loops, unsupported joint types, values
/// that are not numbers, limits in the wrong order, inertias that no body has.
UrdfRobot readUrdf(const std::string& text, const std::string& robot_name);

}  // namespace franka_sim::physics
