// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// @file
/// The parts of the Franka Control Interface, and the features of each version. A version is the
/// robot's unless another device is named. All constant (protocol 1.1, 1.2).

namespace franka_core::fci {

constexpr std::uint16_t kRobotPort = 1337;
constexpr std::uint16_t kGripperPort = 1338;
constexpr std::uint16_t kVacuumGripperPort = 1339;

constexpr std::uint16_t kOldestRobotVersion = 3;
constexpr std::uint16_t kNewestRobotVersion = 10;
constexpr std::uint16_t kNewestPandaVersion = 5;  ///< a Panda speaks 3 to 5, an FR3 6 to 10
constexpr std::uint16_t kOldestGripperVersion = 2;
constexpr std::uint16_t kNewestGripperVersion = 3;
constexpr std::uint16_t kVacuumGripperVersion = 1;

constexpr bool isRobotVersion(std::uint16_t version) noexcept {
  return version >= kOldestRobotVersion && version <= kNewestRobotVersion;
}
constexpr bool isGripperVersion(std::uint16_t version) noexcept {
  return version >= kOldestGripperVersion && version <= kNewestGripperVersion;
}
constexpr bool isVacuumGripperVersion(std::uint16_t version) noexcept {
  return version == kVacuumGripperVersion;
}

/// Panda, also called FER.
constexpr bool isPandaVersion(std::uint16_t version) noexcept {
  return version >= kOldestRobotVersion && version <= kNewestPandaVersion;
}

/// The robot sends its model as a shared object.
constexpr bool hasModelLibrary(std::uint16_t version) noexcept { return version <= 9; }
/// The robot sends its model as a URDF.
constexpr bool hasRobotModel(std::uint16_t version) noexcept { return version >= 8; }
/// Torques can be commanded without a motion generator; commands carry torque_command_finished.
constexpr bool hasTorqueOnlyMove(std::uint16_t version) noexcept { return version >= 7; }
/// Move can use the robot's own point-to-point generator.
constexpr bool hasAsyncMotion(std::uint16_t version) noexcept { return version >= 10; }
/// Filters can be set, virtual walls read.
constexpr bool hasFiltersAndWalls(std::uint16_t version) noexcept { return version <= 5; }
/// Replies report activated safety functions.
constexpr bool hasSafetyFunctions(std::uint16_t version) noexcept { return version >= 6; }

/// A view of bytes owned by others.
struct Bytes {
  const std::uint8_t* data{nullptr};
  std::size_t size{0};
};

/// A message of fixed upper size, so that writing one allocates nothing.
template <std::size_t kCapacity>
struct Message {
  static constexpr std::size_t capacity() noexcept { return kCapacity; }
  Bytes bytes() const noexcept { return {data, size}; }

  std::uint8_t data[kCapacity]{};
  std::size_t size{0};  ///< bytes in use
};

}  // namespace franka_core::fci
