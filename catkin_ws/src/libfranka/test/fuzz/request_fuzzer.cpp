// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/request_codec.h>

#include "fuzz.h"

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of the codec

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::uint16_t version = franka_fuzz::robotVersion(data[0]);
  const Bytes message{data + 1, size - 1};
  Header header;
  Request request;
  if (decodeRequest(version, message, header, request) == CodecError::kNone) {
    RequestMessage again;
    franka_fuzz::require(
        encodeRequest(version, header.command_id, request, again) == CodecError::kNone &&
            again.size == message.size && franka_fuzz::same(again.data, message.data, 12),
        "an accepted request is unchanged after decoding");
  }
  return 0;
}
