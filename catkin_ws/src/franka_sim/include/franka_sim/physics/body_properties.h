// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <string>

namespace franka_sim {

/// Mass and inertia of a body with all that is fixed to it.
struct BodyInertia {
  double mass{0};                  ///< [kg]
  std::array<double, 3> center{};  ///< of mass, in the body's frame [m]
  /// xx, xy, xz, yy, yz, zz about the center of mass, along the body's axes [kg m^2]
  std::array<double, 6> inertia{};
};

/// @throws std::runtime_error with a sentence for an unknown body, and for one that is fixed to
/// another and belongs to that one's inertia. Not real-time safe.
BodyInertia bodyInertia(World& world, const std::string& body);

/// Ends all pushes of a body (World::push). @throws std::runtime_error for an unknown one.
/// Not real-time safe.
void endPushes(World& world, const std::string& body);

}  // namespace franka_sim
