// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <string>
#include <vector>

/// @file
/// The cameras of a World. The thread that uses the world calls them, between ticks. All throw
/// std::runtime_error with a sentence for an unknown name. Not real-time safe.

namespace franka_sim {

/// A camera fixed to the world or to a body: MJCF's `<camera>` or SDF's camera sensor.
struct WorldCamera {
  std::string name;             ///< in the world
  double field_of_view{45};     ///< vertical [deg]
  int width{640}, height{480};  ///< [pixel]; MJCF: attribute user="width height rate"
  double rate{30};              ///< desired pictures per simulated second [Hz]
};

std::vector<WorldCamera> cameras(const World& world);  ///< of the world file and of objects

}  // namespace franka_sim
