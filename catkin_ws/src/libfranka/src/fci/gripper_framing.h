// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>

#include "wire.h"

/// @file
/// Common framing of gripper and vacuum gripper.

namespace franka_core::fci::gripper {

constexpr std::size_t kPlainReplySize = kHeaderSize + sizeof(std::uint16_t);

inline void writeHeader(std::uint16_t command, std::uint32_t command_id, std::size_t size,
                        wire::Writer& writer) noexcept {
  writer.integer(command);
  writer.integer(command_id);
  writer.integer(static_cast<std::uint32_t>(size));
}

inline void writeConnect(const ConnectRequest& request, wire::Writer& writer) noexcept {
  writer.integer(request.version);
  writer.integer(request.udp_port);
}

inline void readConnect(wire::Reader& reader, ConnectRequest& request) noexcept {
  request.version = reader.integer<std::uint16_t>();
  request.udp_port = reader.integer<std::uint16_t>();
}

/// Whether the message is complete and matches its header.
inline bool isWhole(Bytes message, std::size_t max_size, Header& header) noexcept {
  return nextMessage(message, max_size, header) == CodecError::kNone && header.size == message.size;
}

/// Both grippers have the same replies: a status, and for Connect (number 0 of both) a version.
CodecError writeReply(std::uint16_t command, std::uint32_t command_id, const Reply& reply,
                      ReplyMessage& message) noexcept;
CodecError readReply(std::uint16_t command, Bytes message, Header& header, Reply& reply) noexcept;

}  // namespace franka_core::fci::gripper
