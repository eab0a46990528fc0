// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf/model.h>

#include <optional>
#include <string>

namespace franka_sim_mujoco {

/// Which robot an arm is, and how that is known.
struct RobotType {
  std::string name;     ///< "panda" or "fr3"
  std::string why;      ///< clause that goes on after "simulated as one:"
  std::string warning;  ///< clause: what the URDF says when something else was asked for; or empty
};

bool isRobotType(const std::string& name);

/// Tells a Panda from an FR3. What was asked for counts. Without it: the positions that the URDF
/// allows the arm's joints, when only one of the two robots can reach them all; else the joints'
/// velocities, when they are those of one of the two; else whether the URDF is called fr3. The name
/// comes last, since an arm on a mobile base, or one of two, has the name of the whole. Any thread.
/// @param asked one of which isRobotType() is true; nothing when nobody says
/// @param arm_id prefix of the arm's joints
RobotType tellRobotType(const std::optional<std::string>& asked, const urdf::Model& urdf,
                        const std::string& arm_id);

}  // namespace franka_sim_mujoco
