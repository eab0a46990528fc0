// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>

namespace joint_trajectory_controller {
namespace internal {

/// Passes the newest value of the control loop to other threads, the opposite direction of
/// realtime_tools::RealtimeBuffer.
///
/// Wait-free for the one writing thread; readers must exclude each other.
/// @tparam T copyable
template <class T>
class LatestValue {
 public:
  /// Sets all three copies; call it before any thread uses them.
  void init(const T& value) { slots_.fill(value); }

  /// The value to write; it belongs to the writer until publish().
  T& draft() noexcept { return slots_[writer_]; }

  /// Passes the draft to the readers.
  void publish() noexcept {
    writer_ = waiting_.exchange(writer_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  /// The last published value; valid until the next call.
  const T& read() noexcept {
    if ((waiting_.load(std::memory_order_relaxed) & kFresh) != 0) {
      reader_ = waiting_.exchange(reader_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[reader_];
  }

 private:
  static constexpr unsigned kIndex = 3;
  static constexpr unsigned kFresh = 4;

  std::array<T, 3> slots_{};
  unsigned writer_{0};
  std::atomic<unsigned> waiting_{1};
  unsigned reader_{2};
};

}  // namespace internal
}  // namespace joint_trajectory_controller
