// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <string>

#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {

/// Reads the <gazebo> elements of a URDF into the robot: friction, gravity and self-collision of
/// links, cameras, the plugin of ros_control; notes what has no effect here.
/// @param root <robot> @param context the start of an error's sentence
/// @throws std::runtime_error that names the element and the error
void readGazeboElements(const tinyxml2::XMLElement& root, const std::string& context,
                        UrdfRobot* robot);

}  // namespace franka_sim::physics
