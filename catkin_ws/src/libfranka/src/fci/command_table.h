// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>

#include <array>
#include <cstddef>
#include <cstdint>

/// @file
/// The numbers and sizes of commands, each once (protocol 3.1, 3.2).

namespace franka_core::fci::table {

constexpr std::int8_t kAbsent = -1;  // in this version

struct Row {
  Command command;
  std::int8_t from3, from6, from8, from10;  ///< its number from that version on
  std::size_t payload;                      ///< of a request: bytes behind the header
};

constexpr std::array<Row, kCommandCount> kRows{
    {{Command::kConnect, 0, 0, 0, 0, 4},
     {Command::kMove, 1, 1, 1, 1, 56},
     {Command::kStopMove, 2, 2, 2, 2, 0},
     {Command::kGetCartesianLimit, 3, kAbsent, kAbsent, kAbsent, 4},
     {Command::kSetCollisionBehavior, 4, 3, 3, 3, 416},
     {Command::kSetJointImpedance, 5, 4, 4, 4, 56},
     {Command::kSetCartesianImpedance, 6, 5, 5, 5, 48},
     {Command::kSetGuidingMode, 7, 6, 6, 6, 7},
     {Command::kSetEEToK, 8, 7, 7, 7, 128},
     {Command::kSetNEToEE, 9, 8, 8, 8, 128},
     {Command::kSetLoad, 10, 9, 9, 9, 104},
     {Command::kSetFilters, 11, kAbsent, kAbsent, kAbsent, 40},
     {Command::kAutomaticErrorRecovery, 12, 10, 10, 10, 0},
     {Command::kLoadModelLibrary, 13, 11, 11, kAbsent, 2},
     {Command::kGetRobotModel, kAbsent, kAbsent, 12, 11, 0}}};

constexpr const Row& rowOf(Command command) noexcept {
  return kRows[static_cast<std::size_t>(command)];
}

constexpr bool isInOrder() noexcept {
  for (std::size_t i = 0; i < kCommandCount; i++) {
    if (kRows[i].command != static_cast<Command>(i)) {
      return false;
    }
  }
  return true;
}
static_assert(isInOrder());

/// For an existing version.
constexpr std::int8_t numberOf(std::uint16_t version, Command command) noexcept {
  const Row& row = rowOf(command);
  if (version <= 5) {
    return row.from3;
  }
  if (version <= 7) {
    return row.from6;
  }
  return version <= 9 ? row.from8 : row.from10;
}

/// The fields that version 10 appends to Move.
constexpr std::size_t kAsyncMovePayload = 57;

}  // namespace franka_core::fci::table
