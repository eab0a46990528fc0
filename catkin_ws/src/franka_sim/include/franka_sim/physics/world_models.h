// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <string>
#include <vector>

/// @file
/// The models of a World, as Gazebo names them. The thread that uses the world calls them, between
/// ticks. All throw std::runtime_error with a sentence for an unknown name. Not real-time safe.

namespace franka_sim {

/// A joint with one degree of freedom.
struct WorldJoint {
  std::string name;     ///< in the world
  bool slides{false};   ///< prismatic, else revolute
  bool limited{false};  ///< has stops
  double damping{0};    ///< [Nm s/rad] or [N s/m]
};

/// What Gazebo calls a model: a robot, an object, or a top-level body of the world file, with all
/// bodies attached to it.
struct WorldModel {
  std::string name;                ///< of the robot, object or body
  std::string body;                ///< its pose is the model's
  std::vector<std::string> links;  ///< names of bodies; those of SDF models begin with `model::`
  std::vector<WorldJoint> joints;  ///< all with one degree of freedom
  bool is_static{false};           ///< whether nothing of it can move
};

std::vector<WorldModel> models(const World& world);  ///< robots first

}  // namespace franka_sim
