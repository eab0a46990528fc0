// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>

namespace realtime_tools {

/// Passes the newest value from one thread to another. Three copies of it circulate: each side
/// holds one, and exchanges it with the one in between in a single atomic step, so that neither
/// waits for the other. One writer and one reader; several must exclude each other. Real-time safe.
/// Assigning a T must neither allocate nor lock. Not part of the original.
/// @tparam T copyable
template <class T>
class LatestValue {
 public:
  LatestValue() = default;
  explicit LatestValue(const T& value) : slots_{{value, value, value}} {}

  /// Sets all three copies; call it before any thread uses them.
  void init(const T& value) { slots_.fill(value); }

  /// The value to write; it belongs to the writer until publish().
  T& draft() noexcept { return slots_[writer_]; }

  /// Passes the draft to the reader.
  void publish() noexcept {
    writer_ = waiting_.exchange(writer_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// Passes a copy of the value to the reader.
  void write(const T& value) {
    draft() = value;
    publish();
  }

  /// The value published last. It belongs to the reader until its next call, which returns the same
  /// reference if nothing was published meanwhile.
  T& read() noexcept {
    if ((waiting_.load(std::memory_order_relaxed) & kFresh) != 0) {
      reader_ = waiting_.exchange(reader_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[reader_];
  }

  /// What read() returned last.
  T& held() noexcept { return slots_[reader_]; }

 private:
  static constexpr unsigned kIndex = 3;
  static constexpr unsigned kFresh = 4;

  std::array<T, 3> slots_{};
  unsigned writer_{0};
  std::atomic<unsigned> waiting_{1};  ///< index of the slot in between, and whether it is fresh
  unsigned reader_{2};
};

}  // namespace realtime_tools
