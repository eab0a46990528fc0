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

/// Calls `check(bytes, honest)` with the message at every size up to 20 bytes too long. Its header
/// has the size of the whole message; if `honest`, that of the bytes.
/// @param place of the size in the header, an integer of two bytes or more
template <typename Check>
void forEverySize(const std::vector<std::uint8_t>& message, std::size_t place, Check check) {
  for (std::size_t size = 0; size < message.size() + 20; size++) {
    for (const bool honest : {false, true}) {
      std::vector<std::uint8_t> bytes = message;
      bytes.resize(size);
      if (honest && size >= place + 4) {
        bytes[place] = static_cast<std::uint8_t>(size);
        bytes[place + 1] = static_cast<std::uint8_t>(size >> 8);
      }
      check(bytes, honest);
    }
  }
}

}  // namespace franka_test
