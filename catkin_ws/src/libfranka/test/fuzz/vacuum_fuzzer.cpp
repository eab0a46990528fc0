// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/vacuum_codec.h>

#include "fuzz.h"

namespace codec = franka_core::fci::vacuum;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return franka_fuzz::fuzzGripper<codec::Request, codec::RequestMessage, codec::State,
                                  codec::StateBuffer>(data, size);
}
