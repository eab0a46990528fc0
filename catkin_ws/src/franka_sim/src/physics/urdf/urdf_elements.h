// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <array>
#include <string>

namespace franka_sim::physics {

/// Values of a URDF's elements. Not real-time safe. @param where the start of an error's sentence
/// @throws std::runtime_error that names the element and the error

/// Throws an error's sentence.
[[noreturn]] void failAt(const std::string& where, const std::string& what);

/// Three numbers of an attribute; `fallback` without it.
Eigen::Vector3d readVector(const tinyxml2::XMLElement& element, const char* attribute,
                           const std::array<double, 3>& fallback, const std::string& where);

/// The pose of the child <origin>; the identity without one.
Eigen::Isometry3d readOrigin(const tinyxml2::XMLElement& parent, const std::string& where);

}  // namespace franka_sim::physics
