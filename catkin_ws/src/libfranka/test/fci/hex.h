// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>

#include <cstdint>
#include <string>
#include <vector>

namespace franka_test {

/// "0a 0b" or "0a0b" as bytes.
inline std::vector<std::uint8_t> fromHex(const std::string& text) {
  std::vector<std::uint8_t> bytes;
  std::string digits;
  for (const char c : text) {
    if (c != ' ') {
      digits += c;
    }
    if (digits.size() == 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return bytes;
}

template <typename Message>
std::vector<std::uint8_t> toVector(const Message& message) {
  return {message.data, message.data + message.size};
}

inline franka_core::fci::Bytes view(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

}  // namespace franka_test
