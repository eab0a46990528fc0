// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace franka_sim {

/// The description (URDF) of a robot with hand that is installed with franka_sim.
/// @param robot "panda" or "fr3"
/// @param arm_id prefix of all links and joints
/// @throws std::runtime_error if the file is missing
std::string robotText(const std::string& robot, const std::string& arm_id);

/// A description of a robot without its hand: without the link `<arm_id>_hand` and all that is
/// attached to it; the same if there is none. @throws std::runtime_error for text that is no XML
std::string withoutHand(const std::string& urdf, const std::string& arm_id);

/// A description whose links look like those of the robot.
struct RobotLook {
  std::string urdf;                  ///< the text
  std::vector<std::string> missing;  ///< meshes of franka_description that are not installed
};

/// Gives the links of `robotText` the visual meshes of franka_description; a link whose mesh is
/// missing keeps its simple shapes. Collisions stay as they are.
RobotLook robotWithMeshes(const std::string& robot, const std::string& arm_id);

}  // namespace franka_sim
