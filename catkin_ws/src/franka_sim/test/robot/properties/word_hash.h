// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/robot_state.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace franka_sim::test {

/// A hash of the bits of numbers, a word of 64 bits at a time: eight times as fast as FnvHash.
class WordHash {
 public:
  template <typename T>
  void add(T value) noexcept {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof value);
    hash_ = (hash_ ^ word) * 0x9E3779B97F4A7C15U;
    hash_ ^= hash_ >> 32U;
  }
  template <typename T, std::size_t N>
  void add(const std::array<T, N>& values) noexcept {
    for (const T& value : values) {
      add(value);
    }
  }
  void add(const franka_core::Payload& payload) noexcept {
    add(payload.mass);
    add(payload.com);
    add(payload.inertia);
  }
  /// All fields. The first ones fill their part of the struct without gaps.
  void add(const franka_core::RobotState& state) noexcept {
    constexpr std::size_t kWords = offsetof(franka_core::RobotState, motion_generator_mode) / 8;
    std::array<std::uint64_t, kWords> words;
    std::memcpy(words.data(), &state, sizeof words);
    add(words);
    add(state.motion_generator_mode);
    add(state.controller_mode);
    add(state.errors);
    add(state.reflex_reason);
    add(state.robot_mode);
    add(state.control_command_success_rate);
  }

  std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_{0xCBF29CE484222325U};
};

}  // namespace franka_sim::test
