// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/vacuum_codec.h>

#include "fuzz.h"

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of the codec

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const Bytes message{data + 1, size - 1};
  vacuum::Header header;
  vacuum::Request request;
  if (vacuum::decodeRequest(message, header, request) == CodecError::kNone) {
    vacuum::RequestMessage again;
    vacuum::encodeRequest(header.command_id, request, again);
    franka_fuzz::require(
        again.size == message.size && franka_fuzz::same(again.data, message.data, again.size),
        "an accepted request is unchanged after decoding");
  }
  vacuum::Reply reply;
  const auto command = static_cast<vacuum::Command>(data[0] % 4);
  if (vacuum::decodeReply(command, message, header, reply) == CodecError::kNone) {
    vacuum::ReplyMessage again;
    franka_fuzz::require(
        vacuum::encodeReply(command, header.command_id, reply, again) == CodecError::kNone &&
            (again.size == message.size ||
             (command == vacuum::Command::kConnect && again.size < message.size)),
        "an accepted reply is unchanged after decoding");
  }
  vacuum::State state;
  if (vacuum::decodeState(message, state) == CodecError::kNone) {
    vacuum::StateBuffer again{};
    vacuum::encodeState(state, again);
    franka_fuzz::require(franka_fuzz::same(again.data(), message.data, again.size()),
                         "a state is unchanged after decoding");
  }
  return 0;
}
