// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

/// @file
/// Robot, system and libraries of each protocol version, in words. Source: Franka's published
/// compatibility tables (protocol 1.1).

namespace franka_core {

/// One version of the robot's protocol.
struct RobotVersion {
  std::uint16_t version;  ///< of the protocol
  const char* robot;      ///< "Panda" or "FR3"
  const char* system;     ///< the robot's system software
  const char* libraries;  ///< releases of the vendor's libfranka that speak this version
};

/// Of all robots, oldest first.
constexpr std::array<RobotVersion, 8> kRobotVersions{
    {{3, "Panda", "1.3 or later", "0.4 to 0.7"},
     {4, "Panda", "4.0 or later", "0.8"},
     {5, "Panda", "4.2.1 or later", "0.9"},
     {6, "FR3", "5.2.0 or later", "0.10 to 0.13.2"},
     {7, "FR3", "5.5.0 or later", "0.13.3 to 0.13.6"},
     {8, "FR3", "5.7.0 or later", "0.14"},
     {9, "FR3", "5.7.2 or later", "0.15 to 0.17"},
     {10, "FR3", "5.9.0 or later", "0.18 to 0.21"}}};

/// The entry of a version; null for one that is not in the table.
constexpr const RobotVersion* findRobotVersion(std::uint16_t version) noexcept {
  for (const RobotVersion& entry : kRobotVersions) {
    if (entry.version == version) {
      return &entry;
    }
  }
  return nullptr;
}

}  // namespace franka_core
