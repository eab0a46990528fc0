// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <Eigen/Core>
#include <set>
#include <string>

#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {

/// Absolute folder of a file, with the final '/'.
std::string folderOf(const std::string& file);

/// Loads an MJCF file and replaces each <include> by the content of its file.
/// @param title names the file in errors.
/// @throws std::runtime_error with a sentence: unreadable, malformed, included twice or in a
/// circle.
void loadExpanded(const std::string& file, const std::string& title,
                  tinyxml2::XMLDocument* document);

/// Makes the file names of meshes, textures, height fields and skins absolute (removing meshdir and
/// texturedir), so that the text can be compiled anywhere.
void makeFilesAbsolute(tinyxml2::XMLElement* root, const std::string& folder);

/// The inertia of a body near the given one, which rounding in a text may have made impossible: no
/// principal moment is negative, and the largest is at most the sum of the others. A moment that
/// misses by up to kRoundedInertia of the largest one is moved to that limit.
/// @param inertia symmetric, about the center of mass [kg m^2]
/// @param where names the body in errors and notes
/// @param notes gets a sentence part if the inertia was changed visibly
/// @throws std::runtime_error if no body is that near
Eigen::Matrix3d possibleInertia(const Eigen::Matrix3d& inertia, const std::string& where,
                                std::set<std::string>* notes);
/// Of the largest principal moment; chosen here: two digits of a thin disc's moments.
inline constexpr double kRoundedInertia = 0.05;

/// Writes <inertial> with principal axes; nothing for a mass of 0.
void writeInertial(const UrdfInertial& inertial, tinyxml2::XMLElement* body);

/// Makes the inertias written in an MJCF text possible, as possibleInertia does. MuJoCo would
/// refuse them, or with its `balanceinertia` replace them in robots too: that setting is carried
/// out here, for the bodies of this text alone, and removed.
/// @param root <mujoco>. @throws as possibleInertia
void repairInertias(tinyxml2::XMLElement* root, const std::string& title,
                    std::set<std::string>* notes);

}  // namespace franka_sim::physics
