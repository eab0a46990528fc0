// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace franka_core {

/// The hash FNV-1a of 64 bits. Real-time safe.
class FnvHash {
 public:
  void addByte(std::uint8_t byte) noexcept { value_ = (value_ ^ byte) * kPrime; }
  /// Adds eight bytes at once: fast enough for every tick. In FNV-1a alone the upper bits of the
  /// word would not change the lower bits of the value; therefore the value is shifted down by
  /// `mix` bits and combined.
  void addWord(std::uint64_t word, unsigned mix) noexcept {
    value_ = (value_ ^ word) * kPrime;
    value_ ^= value_ >> mix;
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t value_{0xcbf29ce484222325};
};

}  // namespace franka_core
