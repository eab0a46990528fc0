// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <ignition/math/Color.hh>
#include <ignition/math/Pose3.hh>
#include <optional>
#include <sdf/Element.hh>
#include <sdf/Geometry.hh>
#include <sdf/Visual.hh>
#include <set>
#include <string>

#include "physics/sdf_files.h"
#include "physics/sdf_scene.h"

namespace franka_sim_mujoco::physics {

Eigen::Isometry3d toIsometry(const ignition::math::Pose3d& pose);
std::array<double, 3> rgb(const ignition::math::Color& colour);

/// A geometry as a shape at the origin; nothing when there is no counterpart, which `unsupported`
/// then names. @param what names the thing, e.g. "collision 'c' of 'model::link'".
std::optional<SdfShape> readShape(const sdf::Geometry& geometry, const SdfFiles& files,
                                  const std::string& what, std::set<std::string>* unsupported);
/// Friction and contact parameters of a <collision>.
SdfSurface readSurface(const sdf::ElementPtr& collision, const std::string& what,
                       std::set<std::string>* unsupported);
/// A visual's one colour: its diffuse colour, or that of a plain material of Gazebo's. Nothing when
/// it has no material.
std::optional<std::array<double, 4>> readColour(const sdf::Visual& visual, const std::string& what,
                                                std::set<std::string>* unsupported);

}  // namespace franka_sim_mujoco::physics
