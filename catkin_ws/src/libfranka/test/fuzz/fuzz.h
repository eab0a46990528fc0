// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>
#include <franka_core/fci/protocol.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <variant>

/// @file
/// Common part of the fuzzers. Each input is one byte for the version, then the bytes to decode. A
/// fuzzer finds invalid memory accesses (the sanitizers) and accepted messages that are not encoded
/// to the same bytes.

namespace franka_fuzz {

inline void require(bool holds, const char* what) {
  if (!holds) {
    std::fprintf(stderr, "The property does not hold: %s\n", what);
    std::abort();
  }
}

/// Maps the byte to all versions and a few that do not exist.
inline std::uint16_t robotVersion(std::uint8_t byte) {
  return static_cast<std::uint16_t>(byte % 12);
}

inline bool same(const void* a, const void* b, std::size_t size) {
  return std::memcmp(a, b, size) == 0;
}

/// Decodes the input as a request, a reply and a state of the hand or of the vacuum gripper.
template <typename Request, typename RequestMessage, typename State, typename StateBuffer>
int fuzzGripper(const std::uint8_t* data, std::size_t size) {
  using franka_core::fci::CodecError;
  if (size == 0) {
    return 0;
  }
  const franka_core::fci::Bytes message{data + 1, size - 1};
  franka_core::fci::gripper::Header header;
  Request request;
  if (decodeRequest(message, header, request) == CodecError::kNone) {
    RequestMessage again;
    encodeRequest(header.command_id, request, again);
    require(again.size == message.size && same(again.data, message.data, again.size),
            "an accepted request is unchanged after decoding");
  }
  franka_core::fci::gripper::Reply reply;
  using Command = decltype(commandOf(request));
  const auto command = static_cast<Command>(data[0] % std::variant_size_v<Request>);
  if (decodeReply(command, message, header, reply) == CodecError::kNone) {
    franka_core::fci::gripper::ReplyMessage again;
    require(encodeReply(command, header.command_id, reply, again) == CodecError::kNone &&
                (again.size == message.size ||
                 (command == Command::kConnect && again.size < message.size)) &&
                same(again.data + 10, message.data + 10, again.size - 10),
            "an accepted reply is unchanged after decoding");
  }
  State state;
  if (decodeState(message, state) == CodecError::kNone) {
    StateBuffer again{};
    encodeState(state, again);
    require(same(again.data(), message.data, again.size()), "a state is unchanged after decoding");
  }
  return 0;
}

}  // namespace franka_fuzz
