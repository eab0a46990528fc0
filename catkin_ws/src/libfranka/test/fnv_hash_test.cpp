// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fnv_hash.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace {

std::uint64_t hashOf(const std::vector<std::uint8_t>& bytes) {
  franka_core::FnvHash hash;
  hash.addBytes(bytes.data(), bytes.size());
  return hash.value();
}

TEST(FnvHash, EveryBitOfManyBytesCounts) {
  std::vector<std::uint8_t> bytes(77);  // two blocks and a rest
  for (std::size_t i = 0; i < bytes.size(); i++) {
    bytes[i] = static_cast<std::uint8_t>(31 * i);
  }
  std::set<std::uint64_t> seen{hashOf(bytes)};
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit++) {
    std::vector<std::uint8_t> changed = bytes;
    changed[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    seen.insert(hashOf(changed));
  }
  EXPECT_EQ(seen.size(), 1 + 8 * bytes.size());
}

TEST(FnvHash, TheOrderOfWordsCounts) {
  std::set<std::uint64_t> seen;
  for (std::size_t word = 0; word < 8; word++) {
    std::vector<std::uint8_t> moved(64);
    moved[8 * word] = 1;
    seen.insert(hashOf(moved));
  }
  EXPECT_EQ(seen.size(), 8U);
}

TEST(FnvHash, WhatCameBeforeCounts) {
  const std::vector<std::uint8_t> bytes(40, 7);
  franka_core::FnvHash one, other;
  other.addByte(1);
  one.addBytes(bytes.data(), bytes.size());
  other.addBytes(bytes.data(), bytes.size());
  EXPECT_NE(one.value(), other.value());
}

}  // namespace
