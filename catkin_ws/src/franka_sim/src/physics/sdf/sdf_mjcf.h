// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "physics/sdf/sdf_scene.h"

namespace franka_sim::physics {

/// A further name of a body, or of a pose in it: SDF's "model::link", or the model itself.
struct BodyAlias {
  std::string name, body;
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  ///< in the body
};

struct SdfAsMjcf {
  std::vector<BodyAlias> aliases;
};

/// Writes a scene as MJCF into an empty document.
///
/// A model with one link becomes a body of the model's name at the model's pose; the links of other
/// models become bodies "model::link". Joints and cameras are named with their model
/// ("model::joint", "model::link::camera"). A body that is neither static nor held by a joint gets
/// a free joint. A collision's kp and kd turn contacts of a moving link into springs and dampers,
/// if that is softer than the simulator's own contacts and the other surface is not the more
/// slippery one (whose settings MuJoCo takes).
/// @param angle_unit [rad] of the target document
/// @param surroundings writes also gravity, sky and ambient light: for worlds
/// @param resolve for visual meshes
/// Adds to scene->unsupported meshes that cannot be read.
SdfAsMjcf writeSdf(SdfScene* scene, double angle_unit, bool surroundings,
                   tinyxml2::XMLDocument* document);

}  // namespace franka_sim::physics
