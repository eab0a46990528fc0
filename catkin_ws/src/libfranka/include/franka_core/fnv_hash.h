// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace franka_core {

/// The hash FNV-1a of 64 bits. Real-time safe.
class FnvHash {
 public:
  /// Adds one byte.
  void addByte(std::uint8_t byte) noexcept { value_ = (value_ ^ byte) * kPrime; }
  /// Adds eight bytes at once: fast enough for every tick. In FNV-1a alone the upper bits of the
  /// word would not change the lower bits of the value; therefore the value is shifted down by
  /// `mix` bits and combined.
  void addWord(std::uint64_t word, unsigned mix) noexcept {
    value_ = (value_ ^ word) * kPrime;
    value_ ^= value_ >> mix;
  }
  /// Adds many bytes as four hashes of every fourth word, which a processor computes side by side:
  /// a multiplication of one hash waits for the one before.
  void addBytes(const std::uint8_t* bytes, std::size_t size) noexcept {
    std::array<FnvHash, 4> lanes{*this, *this, *this, *this};
    const std::size_t whole = size - size % kBlock;
    for (std::size_t i = 0; i < whole; i += kBlock) {
      std::array<std::uint64_t, 4> words;
      std::memcpy(words.data(), bytes + i, kBlock);
      for (std::size_t lane = 0; lane < lanes.size(); lane++) {
        lanes[lane].addWord(words[lane], kMix);
      }
    }
    for (const FnvHash& lane : lanes) {
      addWord(lane.value_, kMix);
    }
    for (std::size_t i = whole; i < size; i++) {
      addByte(bytes[i]);
    }
  }
  std::uint64_t value() const noexcept { return value_; }  ///< of all bytes so far

 private:
  static constexpr std::size_t kBlock = 32;
  static constexpr unsigned kMix = 32;
  static constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t value_{0xcbf29ce484222325};
};

}  // namespace franka_core
