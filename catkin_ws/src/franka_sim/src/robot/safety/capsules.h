// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace franka_sim {

/// A cylinder with a half sphere on either end, fixed to a link.
struct Capsule {
  int link;                        ///< 0 to 7; kHandLink for the hand
  std::array<double, 3> from, to;  ///< centers of the half spheres, in the link's frame [m]
  double radius;                   ///< [m]
};

constexpr std::size_t kCapsuleCount = 12;

/// The coarse volumes of arm and hand: those of the links `_sc` of the robot's description, without
/// safety distance. A test compares both.
extern const std::array<Capsule, kCapsuleCount> kCapsules;

}  // namespace franka_sim
