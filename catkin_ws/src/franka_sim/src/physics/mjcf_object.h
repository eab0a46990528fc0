// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <tinyxml2.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "physics/sdf_mjcf.h"

namespace franka_sim::physics {

/// A thing put into the world while it runs: MJCF with files absolute, bodies and geoms named and
/// the outermost bodies at their places.
struct MjcfObject {
  std::string name;
  tinyxml2::XMLDocument document;
  std::vector<BodyAlias> aliases;
  std::set<std::string> unsupported;
};

/// Reads an object: an SDF text with one model, an MJCF text with bodies, or a lone <body>.
/// @param pose what stands at the text's origin is put there
/// @param angle_unit of the world it goes into [rad]; an MJCF text must have the same
/// @throws std::runtime_error with a sentence: broken text, sections that would change the whole
/// world, what MuJoCo refuses.
std::shared_ptr<const MjcfObject> readObject(const std::string& name, const std::string& text,
                                             const Pose& pose, double angle_unit,
                                             const ResourceResolver& resolve);

/// Gives geoms without a name one: "<prefix>/geom_<n>".
void nameGeoms(tinyxml2::XMLElement* body, const std::string& prefix, int* count);

}  // namespace franka_sim::physics
