// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/robot_state.h>

#include <array>

/// @file
/// The state datagram, robot to client, once a millisecond. The caller owns the buffers; no
/// function throws. Real-time safe. Thread-safe.

namespace franka_core::fci {

constexpr std::size_t kMaxStateSize = 2373;

using StateBuffer = std::array<std::uint8_t, kMaxStateSize>;

/// Type of a field's numbers in the datagram.
enum class WireType : std::uint8_t { kU8, kBool, kU64, kF32, kF64 };

/// One field of the datagram, for tests and for the inspection of datagrams.
struct StateField {
  const char* name;
  std::size_t count;
  WireType type;
  std::size_t offset;  ///< [bytes] from the datagram's start
};

constexpr std::size_t kStateFieldCount = 48;

/// The layout of one version: the first `count` of `fields`.
struct StateLayout {
  std::array<StateField, kStateFieldCount> fields;
  std::size_t count;
  std::size_t size;  ///< [bytes] of the datagram
};

/// The version's layout; null for an unknown version.
const StateLayout* stateLayout(std::uint16_t version) noexcept;

/// Size of the datagram: 2085 (version 3), 2341 (4), 2373 (5 to 9), 1377 (10); 0 for others.
std::size_t stateSize(std::uint16_t version) noexcept;

/// Robot: writes the first stateSize(version) bytes of `buffer`. Version 10 carries single
/// precision. Fails with kUnknownVersion or kNotInThisVersion (a motion generator mode the version
/// lacks).
CodecError encodeState(std::uint16_t version, const RobotState& state,
                       StateBuffer& buffer) noexcept;

/// Client: reads a datagram of exactly stateSize(version) bytes. Fields that the version lacks get
/// the values of such a robot: version 3 has F_T_NE the identity and NE_T_EE = F_T_EE, versions 3
/// and 4 have O_ddP_O = (0, 0, -9.81) and the later errors false, accelerometers are zero before
/// 10. The total payload is combined from end effector and load. Fails with kUnknownVersion,
/// kWrongSize, kUnknownEnum, kBadBoolean, and then leaves `state` unchanged.
CodecError decodeState(std::uint16_t version, Bytes datagram, RobotState& state) noexcept;

}  // namespace franka_core::fci
