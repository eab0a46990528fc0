// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/reply_codec.h>

#include "fuzz.h"

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of the codec

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  // The high bits select the command that the client waits for.
  const std::uint16_t version = franka_fuzz::robotVersion(data[0] & 0x0fU);
  const Bytes message{data + 1, size - 1};
  for (std::size_t i = data[0] >> 4U; i < kCommandCount; i += 16) {
    const auto command = static_cast<Command>(i);
    Header header;
    Reply reply;
    Bytes model;
    if (decodeReply(version, command, message, header, reply, model) == CodecError::kNone) {
      franka_fuzz::require(
          model.size == 0 || model.data + model.size == message.data + message.size,
          "a model ends where its message ends");
      ReplyMessage again;
      franka_fuzz::require(
          encodeReply(version, command, header.command_id, reply, again) == CodecError::kNone &&
              (again.size + model.size == message.size ||
               (command == Command::kConnect && again.size < message.size)) &&
              again.data[12] == message.data[12],
          "an accepted reply is unchanged after decoding");
    }
  }
  return 0;
}
