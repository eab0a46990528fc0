// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>

namespace franka_sim::physics {

/// Makes the joints of a URDF fixed that cannot move: revolute and prismatic ones without <limit>,
/// or whose limits are equal, at that position.
/// @param root <robot>; unchanged if it has no such joint. @param notes gets their names
/// @returns whether there was one. @throws std::runtime_error for values that are not numbers
bool holdJoints(tinyxml2::XMLElement* root, const std::string& where, std::set<std::string>* notes);

}  // namespace franka_sim::physics
