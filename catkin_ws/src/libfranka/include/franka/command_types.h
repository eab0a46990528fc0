// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

/// @file
/// Types of the robot's non-realtime commands.

namespace franka {

/// A box that the end effector must not leave, as kept by the robot (robot protocol up to version
/// 5).
struct VirtualWallCuboid {
  int32_t id{};                               ///< number of the wall
  std::array<double, 3> object_world_size{};  ///< edge lengths of the box [m]
  std::array<double, 16> p_frame{};           ///< pose of the box in O, 4x4 column-major
  bool active{};                              ///< whether the robot enforces it
};

}  // namespace franka
