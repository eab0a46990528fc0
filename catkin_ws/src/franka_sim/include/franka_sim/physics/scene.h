// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_lights.h>

#include <map>
#include <string>
#include <vector>

namespace franka_sim {

/// The data that drawing needs: captured by the stepping thread, drawn by another.
struct Scene {
  std::string mjcf;                      ///< World::mjcf(true)
  std::map<std::string, Pose> bodies;    ///< free bodies
  std::map<std::string, double> joints;  ///< joints with one degree of freedom [rad] or [m]
  std::vector<WorldLight> lights;  ///< all, in the order of the model, in their bodies' frames
  std::vector<Contact> contacts;   ///< for the window's arrows
  double time{0};                  ///< of the world [s]
  std::string fault;               ///< World::fault
};

/// Captures what `Renderer` needs from a world. The stepping thread calls it, between ticks; it
/// allocates.
Scene captureScene(World& world);

}  // namespace franka_sim
