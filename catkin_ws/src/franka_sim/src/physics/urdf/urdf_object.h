// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <string>

#include "physics/sdf/sdf_scene.h"

namespace franka_sim::physics {

/// An object's URDF as an SDF scene with one model of that name, whose root link is at the origin
/// and free to move, unless <gazebo><static> is true.
/// @param resolve finds its meshes
SdfScene readUrdfObject(const std::string& text, const std::string& name,
                        const ResourceResolver& resolve);

}  // namespace franka_sim::physics
