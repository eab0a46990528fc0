// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/state_codec.h>

#include "fuzz.h"

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of the codec

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::uint16_t version = franka_fuzz::robotVersion(data[0]);
  const Bytes datagram{data + 1, size - 1};
  franka_core::RobotState state;
  if (decodeState(version, datagram, state) == CodecError::kNone) {
    StateBuffer again{};
    franka_fuzz::require(encodeState(version, state, again) == CodecError::kNone,
                         "an accepted state can be written");
    franka_core::RobotState twice;
    franka_fuzz::require(
        decodeState(version, {again.data(), datagram.size}, twice) == CodecError::kNone,
        "a state that was written is accepted");
    // Signaling NaNs may lose a bit in registers, so only modes and id are compared.
    franka_fuzz::require(twice.message_id == state.message_id && twice.errors == state.errors &&
                             twice.robot_mode == state.robot_mode,
                         "a state is unchanged after decoding");
  }
  return 0;
}
