// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <string>
#include <vector>

/// @file
/// Functions that read what touches what in a World. The thread that uses the world calls them,
/// between ticks. All throw std::runtime_error with a sentence for an unknown name.
/// Not real-time safe.

namespace franka_sim {

/// A contact between two bodies.
struct Contact {
  std::string body1, body2;        ///< names
  std::array<double, 3> position;  ///< world [m]
  std::array<double, 3> force;     ///< on body2, world axes [N]
};

/// What touches a body.
struct Touches {
  std::vector<std::string> robots;  ///< each once
  bool others{false};               ///< anything else
};

/// A robot's link and a body of something else that penetrate each other.
struct Overlap {
  std::string link, body;  ///< names
  double depth;            ///< [m]
};

std::vector<Contact> contacts(const World& world);  ///< at this tick
/// What contacts() returns of one body, in brief.
Touches touches(const World& world, const std::string& body);
/// Where a robot penetrates other bodies, by more than 1 mm.
std::vector<Overlap> overlaps(const World& world, const std::string& robot);
/// A sentence about them; empty when there are none.
std::string describeOverlaps(const World& world, const std::string& robot);

}  // namespace franka_sim
