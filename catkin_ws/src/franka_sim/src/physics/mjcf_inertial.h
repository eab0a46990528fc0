// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include "physics/urdf_robot.h"

namespace franka_sim::physics {

/// Writes a body's <inertial>, unless it has no mass.
void writeInertial(const UrdfInertial& inertial, tinyxml2::XMLElement* body);

}  // namespace franka_sim::physics
