// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/robot_state.h>

#include <array>

/// @file
/// The command datagram, client to robot, one for each state. Real-time safe: no allocation, lock
/// or exception; buffers are the caller's.

namespace franka_core::fci {

constexpr std::size_t kMaxCommandSize = 371;

using CommandBuffer = std::array<std::uint8_t, kMaxCommandSize>;

/// 370 up to version 6, 371 from version 7 on; 0 for a version that does not exist.
std::size_t commandSize(std::uint16_t version) noexcept;

/// Client: writes the first commandSize(version) bytes of `buffer`. Numbers are written as they
/// are; torque_command_finished is dropped where the version has no place for it. Fails with
/// kUnknownVersion.
CodecError encodeCommand(std::uint16_t version, const RobotCommand& command,
                         CommandBuffer& buffer) noexcept;

/// Robot: reads a datagram of exactly commandSize(version) bytes. kNotFinite means that the command
/// was read whole and holds a number that is infinite or none: the control unit raises its flag for
/// it. On kUnknownVersion, kWrongSize and kBadBoolean `command` stays as it was.
CodecError decodeCommand(std::uint16_t version, Bytes datagram, RobotCommand& command) noexcept;

}  // namespace franka_core::fci
