// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>

#include <array>
#include <cstddef>
#include <cstdint>

/// @file
/// The numbers and sizes of commands, each once (protocol 3.1, 3.2). Columns are in the order of
/// Command.

namespace franka_core::fci::table {

using Numbers = std::array<std::int8_t, kCommandCount>;  // -1: not in this version

// Connect, Move, StopMove, GetCartesianLimit, SetCollisionBehavior, SetJointImpedance,
// SetCartesianImpedance, SetGuidingMode, SetEEToK, SetNEToEE, SetLoad, SetFilters,
// AutomaticErrorRecovery, LoadModelLibrary, GetRobotModel
constexpr Numbers kVersions3To5{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, -1}};
constexpr Numbers kVersions6And7{{0, 1, 2, -1, 3, 4, 5, 6, 7, 8, 9, -1, 10, 11, -1}};
constexpr Numbers kVersions8And9{{0, 1, 2, -1, 3, 4, 5, 6, 7, 8, 9, -1, 10, 11, 12}};
constexpr Numbers kVersion10{{0, 1, 2, -1, 3, 4, 5, 6, 7, 8, 9, -1, 10, -1, 11}};

/// For an existing version.
constexpr const Numbers& numbers(std::uint16_t version) noexcept {
  if (version <= 5) {
    return kVersions3To5;
  }
  if (version <= 7) {
    return kVersions6And7;
  }
  return version <= 9 ? kVersions8And9 : kVersion10;
}

/// Bytes after the header.
constexpr std::array<std::size_t, kCommandCount> kRequestPayload{
    {4, 56, 0, 4, 416, 56, 48, 7, 128, 128, 104, 40, 0, 2, 0}};

/// What version 10 appends to Move.
constexpr std::size_t kAsyncMovePayload = 57;

}  // namespace franka_core::fci::table
