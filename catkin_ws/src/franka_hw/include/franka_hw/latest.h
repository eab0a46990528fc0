// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace franka_hw {

/// Passes the newest value from one thread to another. There are three copies: each side holds one
/// and the third one is exchanged, so that neither thread waits for the other. One writer, one
/// reader. Real-time safe. Copying a T must neither allocate nor lock.
template <typename T>
class Latest {
 public:
  explicit Latest(const T& value = T()) : slots_{{value, value, value}} {}

  /// Replaces the previous value. Called by one thread.
  void write(const T& value) noexcept {
    slots_[back_] = value;
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) &
            kIndex;
  }

  /// The value written last. Called by one thread; the reference is valid until the next call.
  const T& read() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) {
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[front_];
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;

  std::array<T, 3> slots_;
  std::uint8_t back_{0};
  std::atomic<std::uint8_t> middle_{1};
  std::uint8_t front_{2};
};

}  // namespace franka_hw
