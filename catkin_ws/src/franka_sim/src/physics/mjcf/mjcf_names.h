// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <set>
#include <string>
#include <utility>

namespace franka_sim::physics {

/// Names of an MJCF document with their kinds (body, geom, joint, ...): names of different kinds
/// may be equal.
using MjcfNames = std::set<std::pair<std::string, std::string>>;

/// All names below an element, also those that MuJoCo takes from the files of meshes, textures and
/// height fields.
MjcfNames namesOf(const tinyxml2::XMLElement& root);

/// Puts a prefix before all of these names, and where the document refers to them.
void prefixNames(tinyxml2::XMLElement* root, const std::string& prefix);

}  // namespace franka_sim::physics
