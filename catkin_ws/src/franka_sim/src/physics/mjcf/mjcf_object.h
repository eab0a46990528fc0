// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <tinyxml2.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "physics/sdf/sdf_mjcf.h"

namespace franka_sim::physics {

/// An object added to the running world: MJCF with absolute files, named bodies and geoms, and its
/// top-level bodies at their poses.
struct MjcfObject {
  std::string name;
  tinyxml2::XMLDocument document;
  std::vector<BodyAlias> aliases;
  std::set<std::string> unsupported;
};

/// Reads an object: an SDF text with one model, an MJCF text with bodies, a lone <body>, or the
/// URDF of an object.
/// @param pose of the text's origin
/// @param angle_unit of the world [rad], to which other angles are converted
/// @throws std::runtime_error with a sentence: broken text, sections that would change the whole
/// world, errors of MuJoCo.
std::shared_ptr<MjcfObject> readObject(const std::string& name, const std::string& text,
                                       const Pose& pose, double angle_unit,
                                       const ResourceResolver& resolve);

/// Lets an object's names begin with "<object>::" if the world has one of them already, and notes
/// it. @param world the document that the object becomes part of
void avoidNamesOf(const tinyxml2::XMLElement& world, MjcfObject* object);

/// Removes the <keyframe> sections: their states lack those of robots. @returns a note about them
std::set<std::string> dropKeyframes(tinyxml2::XMLElement* root);

/// A note if the file sets autolimits="false": ranges limit all the same, as in MuJoCo 3. Empty
/// otherwise. Call before that setting is replaced.
std::set<std::string> noteAutolimits(const tinyxml2::XMLElement& root);

/// Names unnamed geoms "<prefix>/geom_<n>".
void nameGeoms(tinyxml2::XMLElement* body, const std::string& prefix, int* count);

}  // namespace franka_sim::physics
