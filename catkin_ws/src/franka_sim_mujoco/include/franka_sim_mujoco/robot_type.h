// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf/model.h>

#include <optional>
#include <string>

namespace franka_sim_mujoco {

/// The type of an arm, and how it was determined.
struct RobotType {
  std::string name;     ///< "panda" or "fr3"
  std::string why;      ///< clause that continues "simulated as one:"
  std::string warning;  ///< clause: the URDF's type if it contradicts the parameter; or empty
};

bool isRobotType(const std::string& name);

/// Determines whether an arm is a Panda or an FR3. `configured` counts if given. Otherwise: the
/// positions that the URDF allows for the arm's joints, if only one of the two robots can reach
/// them all; else the joints' velocities, if they are those of one of the two; else whether the
/// URDF is called fr3. The name comes last, because an arm on a mobile base, or one of two, has the
/// name of the whole. Thread-safe.
/// @param configured one for which isRobotType() is true; empty if not configured
/// @param arm_id prefix of the arm's joints
RobotType determineRobotType(const std::optional<std::string>& configured, const urdf::Model& urdf,
                             const std::string& arm_id);

}  // namespace franka_sim_mujoco
