// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/command_codec.h>

#include "fuzz.h"

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of the codec

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::uint16_t version = franka_fuzz::robotVersion(data[0]);
  const Bytes datagram{data + 1, size - 1};
  franka_core::RobotCommand command;
  const CodecError error = decodeCommand(version, datagram, command);
  if (error == CodecError::kNone || error == CodecError::kNotFinite) {
    CommandBuffer again{};
    franka_fuzz::require(encodeCommand(version, command, again) == CodecError::kNone &&
                             (error == CodecError::kNotFinite ||
                              franka_fuzz::same(again.data(), datagram.data, datagram.size)),
                         "an accepted command is unchanged after decoding");
  }
  return 0;
}
