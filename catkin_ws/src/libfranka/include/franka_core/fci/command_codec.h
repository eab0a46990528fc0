// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/robot_state.h>

#include <array>

/// @file
/// The command datagram, client to robot, one per state. The caller owns the buffers; no function
/// throws. Real-time safe. Thread-safe.

namespace franka_core::fci {

constexpr std::size_t kMaxCommandSize = 371;

using CommandBuffer = std::array<std::uint8_t, kMaxCommandSize>;

/// 370 up to version 6, 371 from version 7 on; 0 for a version that does not exist.
std::size_t commandSize(std::uint16_t version) noexcept;

/// Client: writes the first commandSize(version) bytes of `buffer`. Numbers are written unchanged;
/// torque_command_finished is dropped if the version has no such field. Fails with kUnknownVersion.
CodecError encodeCommand(std::uint16_t version, const RobotCommand& command,
                         CommandBuffer& buffer) noexcept;

/// Robot: reads a datagram of exactly commandSize(version) bytes. kNotFinite means that the command
/// was read completely and contains a number that is not finite, for which the control unit raises
/// a flag. On kUnknownVersion, kWrongSize and kBadBoolean `command` is unchanged.
CodecError decodeCommand(std::uint16_t version, Bytes datagram, RobotCommand& command) noexcept;

}  // namespace franka_core::fci
