// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <string>

/// @file
/// Functions that read and change the lights of a World by their names. The thread that uses the
/// world calls them, between ticks. All throw std::runtime_error with a sentence for an unknown
/// name; those that change something also while the world has stopped (World::stopped), and for
/// numbers beyond the limits of input_limits.h. Not real-time safe.

namespace franka_sim {

/// A light of the world file or of an object, as it is drawn. Lights of SDF links are called
/// model::link::light.
struct WorldLight {
  bool on{true};                                 ///< drawn; false for one that was removed
  bool shadows{true};                            ///< whether it casts them
  std::array<double, 3> diffuse{}, specular{};   ///< red, green, blue: 0 to 1
  std::array<double, 3> attenuation{{1, 0, 0}};  ///< constant, linear [1/m], quadratic [1/m^2]
  std::array<double, 3> position{};              ///< in the world, or in the light's link [m]
  std::array<double, 3> direction{{0, 0, -1}};   ///< likewise, of any length but 0
};

/// @throws std::runtime_error with a sentence for an unknown or removed one
WorldLight light(const World& world, const std::string& name);
/// Lasts until its object is removed; a reset does not change it. @throws std::runtime_error also
/// for negative colors or attenuations and positions beyond sizes::kMaxPosition
void setLight(World& world, const std::string& name, const WorldLight& light);

}  // namespace franka_sim
