// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace franka_sim {

/// Whether a URDF describes an object that is free to move, as Gazebo's spawner takes it: it has
/// neither a Franka arm, nor transmissions, nor a plugin of ros_control, nor a link `world`.
/// Thread-safe. Not real-time safe. @returns false for a text that is not a URDF
bool isUrdfOfObject(const std::string& urdf);

/// The URDF with the joints fixed that have no range (as physics does), so that parsers that refuse
/// a revolute joint without limits read it. The same text if there are none.
/// Thread-safe. Not real-time safe. @throws std::runtime_error for limits that are not numbers
std::string withHeldJoints(const std::string& urdf);

}  // namespace franka_sim
