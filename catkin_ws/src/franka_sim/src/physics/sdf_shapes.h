// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <array>
#include <optional>
#include <set>
#include <string>

#include "physics/sdf_scene.h"

namespace franka_sim::physics {

/// Red, green and blue (0 to 1) in a child element, with or without opacity; `fallback` if there is
/// none.
std::array<double, 4> readColor(const tinyxml2::XMLElement& element, const char* name,
                                const std::array<double, 4>& fallback, const std::string& where);

/// The <geometry> of a collision or visual as a shape at the origin; empty if it has no
/// counterpart, which is then added to `unsupported`.
/// @param what names the element, e.g. "collision 'c' of 'model::link'".
/// @throws std::runtime_error when a number is missing or is not one.
std::optional<SdfShape> readShape(const tinyxml2::XMLElement& thing, const std::string& what,
                                  std::set<std::string>* unsupported);
/// Friction and contact parameters of a <collision>.
SdfSurface readSurface(const tinyxml2::XMLElement& collision, const std::string& what,
                       std::set<std::string>* unsupported);
/// A visual's color: its diffuse color, or that of one of Gazebo's plain materials. Empty if it
/// has no material.
std::optional<std::array<double, 4>> readMaterial(const tinyxml2::XMLElement& visual,
                                                  const std::string& what,
                                                  std::set<std::string>* unsupported);

}  // namespace franka_sim::physics
