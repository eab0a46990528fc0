// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

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

}  // namespace franka_fuzz
