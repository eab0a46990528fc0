// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>

#include "wire.h"

/// @file
/// Common framing of gripper and vacuum gripper.

namespace franka_core::fci::gripper {

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

inline ConnectRequest readConnect(wire::Reader& reader) noexcept {
  ConnectRequest request;
  request.version = reader.integer<std::uint16_t>();
  request.udp_port = reader.integer<std::uint16_t>();
  return request;
}

/// Whether the message is complete and matches its header.
inline bool isWhole(Bytes message, std::size_t max_size, Header& header) noexcept {
  return nextMessage(message, max_size, header) == CodecError::kNone && header.size == message.size;
}

/// The size of a request with header; 0 for unknown commands.
/// @param payload bytes after the header, in the order of the commands
template <std::size_t kCommands>
std::size_t sizeOfRequest(const std::array<std::size_t, kCommands>& payload,
                          std::size_t command) noexcept {
  return command < kCommands ? kHeaderSize + payload[command] : 0;
}

/// Writes header and fields, these by `write(fields, writer)`.
template <std::size_t kCommands, typename Request, std::size_t kMaxSize, typename Write>
void writeRequest(const std::array<std::size_t, kCommands>& payload, std::uint32_t command_id,
                  const Request& request, Message<kMaxSize>& message, Write write) noexcept {
  message.size = sizeOfRequest(payload, request.index());
  wire::Writer writer(message.data);
  writeHeader(static_cast<std::uint16_t>(request.index()), command_id, message.size, writer);
  std::visit([&](const auto& fields) noexcept { write(fields, writer); }, request);
}

/// Reads the header of a request and checks its size.
template <std::size_t kCommands>
CodecError readRequestHeader(const std::array<std::size_t, kCommands>& payload,
                             std::size_t max_size, Bytes message, Header& header) noexcept {
  if (!isWhole(message, max_size, header)) {
    return CodecError::kWrongSize;
  }
  if (header.command >= kCommands) {
    return CodecError::kUnknownCommand;
  }
  return message.size == sizeOfRequest(payload, header.command) ? CodecError::kNone
                                                                : CodecError::kWrongSize;
}

}  // namespace franka_core::fci::gripper
