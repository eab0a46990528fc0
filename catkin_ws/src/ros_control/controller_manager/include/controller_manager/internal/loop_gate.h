// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace controller_manager {
namespace internal {

/// Shows threads outside the control loop when the loop can no longer use an object that they
/// removed.
///
/// The loop passes the gate with a Visit around all its reading. Another thread first replaces the
/// pointer that the loop reads (sequentially consistent), then calls waitUntilLeft(): afterwards
/// every visit has ended or reads the new pointer. A loop that stands still is outside the gate, so
/// no thread waits for it. The loop's side is two stores, without lock or wait.
class LoopGate {
 public:
  /// Far above a cycle of a millisecond: beyond it the loop hangs inside a controller.
  static constexpr std::chrono::milliseconds kMaxCycleTime{1000};

  /// One cycle of the loop. Only one visit exists at a time.
  class Visit {
   public:
    explicit Visit(LoopGate& gate) : gate_(gate) {
      gate_.holder_.store(std::this_thread::get_id(), std::memory_order_relaxed);
      gate_.epoch_.store(gate_.epoch_.load(std::memory_order_relaxed) + 1,
                         std::memory_order_seq_cst);
    }
    ~Visit() {
      gate_.epoch_.store(gate_.epoch_.load(std::memory_order_relaxed) + 1,
                         std::memory_order_release);
    }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

   private:
    LoopGate& gate_;
  };

  /// Waits for the end of the present visit, if any.
  /// @returns false if it did not end in time: the removed object must then be kept.
  bool waitUntilLeft(std::chrono::milliseconds at_most) const {
    const std::uint64_t epoch = epoch_.load(std::memory_order_seq_cst);
    if (!isVisit(epoch)) {
      return true;
    }
    const auto deadline = std::chrono::steady_clock::now() + at_most;
    while (epoch_.load(std::memory_order_seq_cst) == epoch) {
      if (std::chrono::steady_clock::now() > deadline) {
        return false;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    return true;
  }

  /// Whether the calling thread is in a visit: it must not wait for the loop.
  bool isVisitedByThisThread() const {
    return isVisit(epoch_.load(std::memory_order_seq_cst)) &&
           holder_.load(std::memory_order_relaxed) == std::this_thread::get_id();
  }

 private:
  static bool isVisit(std::uint64_t epoch) { return epoch % 2 == 1; }

  std::atomic<std::uint64_t> epoch_{0};  ///< odd during a visit
  std::atomic<std::thread::id> holder_{std::thread::id()};
};

}  // namespace internal
}  // namespace controller_manager
