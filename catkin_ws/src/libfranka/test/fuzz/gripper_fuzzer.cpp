// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/gripper_codec.h>

#include "fuzz.h"

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of the codec

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const Bytes message{data + 1, size - 1};
  gripper::Header header;
  gripper::Request request;
  if (gripper::decodeRequest(message, header, request) == CodecError::kNone) {
    gripper::RequestMessage again;
    gripper::encodeRequest(header.command_id, request, again);
    franka_fuzz::require(
        again.size == message.size && franka_fuzz::same(again.data, message.data, 10),
        "an accepted request is unchanged after decoding");
  }
  gripper::Reply reply;
  const auto command = static_cast<gripper::Command>(data[0] % 5);
  if (gripper::decodeReply(command, message, header, reply) == CodecError::kNone) {
    gripper::ReplyMessage again;
    franka_fuzz::require(
        gripper::encodeReply(command, header.command_id, reply, again) == CodecError::kNone &&
            (again.size == message.size ||
             (command == gripper::Command::kConnect && again.size < message.size)) &&
            franka_fuzz::same(again.data + 10, message.data + 10, again.size - 10),
        "an accepted reply is unchanged after decoding");
  }
  gripper::State state;
  if (gripper::decodeState(message, state) == CodecError::kNone) {
    gripper::StateBuffer again{};
    gripper::encodeState(state, again);
    franka_fuzz::require(again[20] == message.data[20], "a state is unchanged after decoding");
  }
  return 0;
}
