// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>

#include <optional>

/// @file
/// The robot's TCP channel, requests. Framing: a header of 12 bytes (u32 command, u32 command id,
/// u32 size of header and payload), then the payload; little-endian, packed. Pure functions that
/// throw nothing. Real-time safe. Thread-safe.

namespace franka_core::fci {

constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kMaxRequestSize = 428;  ///< SetCollisionBehavior
constexpr std::size_t kMaxReplySize =
    64 * 1024 * 1024;  ///< bound on models, chosen here; other replies have at most 166

struct Header {
  std::uint32_t command{0};     ///< number in the peer's version
  std::uint32_t command_id{0};  ///< counts a client's requests; replies repeat it
  std::uint32_t size{0};        ///< [bytes], of header and payload
};

using RequestMessage = Message<kMaxRequestSize>;

/// The command's number in this version; empty if the version has no such command.
std::optional<std::uint32_t> commandNumber(std::uint16_t version, Command command) noexcept;

/// The command of a number in this version.
std::optional<Command> commandFromNumber(std::uint16_t version, std::uint32_t number) noexcept;

/// Size of a request in this version, header included; 0 if the version has no such command.
std::size_t requestSize(std::uint16_t version, Command command) noexcept;

/// Finds the first message of a TCP stream. kNone: `header` is its header and header.size bytes of
/// `stream` are the message. kIncomplete: read more. kTooLong (more than `max_size`) and kWrongSize
/// (less than a header): the rest of the stream is unusable. For requests and replies.
CodecError nextMessage(Bytes stream, std::size_t max_size, Header& header) noexcept;

/// Client: writes a request. Fails with kUnknownVersion, kNotInThisVersion (a command or mode) or
/// kUnknownEnum (a mode that cannot be requested); `message` is then empty.
CodecError encodeRequest(std::uint16_t version, std::uint32_t command_id, const Request& request,
                         RequestMessage& message) noexcept;

/// Robot: reads one complete request. `header` is filled if there are 12 bytes, so that a bad
/// request can be answered. Numbers that are not finite are passed on: the control unit checks
/// arguments. Fails with kUnknownVersion, kWrongSize, kUnknownCommand, kUnknownEnum,
/// kNotInThisVersion (a mode), kBadBoolean. Connect is the same in every version.
CodecError decodeRequest(std::uint16_t version, Bytes message, Header& header,
                         Request& request) noexcept;

}  // namespace franka_core::fci
