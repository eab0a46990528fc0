// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace realtime_tools {
namespace detail {

/// A lock around one message that also stores the turn: of the real-time side, which fills the
/// message, or of the publishing thread, which sends it.
///
/// It is one atomic word, so that the real-time side needs no mutex and no system call: it wakes no
/// thread, the other sides poll.
///
/// Thread-safe. Real-time safe. Exception: lock().
class TurnLock {
 public:
  /// Starts closed: tryLock() fails until open().
  TurnLock() = default;
  TurnLock(const TurnLock&) = delete;
  TurnLock& operator=(const TurnLock&) = delete;

  /// Gives the first turn to the real-time side. No other thread may use the lock meanwhile.
  void open() noexcept { word_.store(0, std::memory_order_release); }

  /// Takes the lock if it is free and it is the real-time side's turn. Never waits.
  bool tryLock() noexcept { return take(kLocked | kHandedOver | kClosed, 0); }

  /// For the publishing thread: takes the lock if it is free, its turn, and not stopped.
  bool tryTakeTurn() noexcept { return take(kLocked | kHandedOver | kStopped, kHandedOver); }

  /// Takes the lock on any turn; waits while another thread holds it.
  void lock() noexcept {
    while (!take(kLocked, 0)) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  }

  /// Releases the lock; the turn stays.
  void unlock() noexcept { change(kLocked, 0); }

  /// Releases the lock and gives the turn to the publishing thread.
  void unlockAndHandOver() noexcept { change(kLocked, kHandedOver); }

  /// For the publishing thread: releases lock and turn.
  void unlockAndReturn() noexcept { change(kLocked | kHandedOver, 0); }

  /// Disables tryTakeTurn() until the next open().
  void stop() noexcept { change(0, kStopped); }

 private:
  static constexpr std::uint32_t kLocked = 1;
  static constexpr std::uint32_t kHandedOver = 2;
  static constexpr std::uint32_t kStopped = 4;
  static constexpr std::uint32_t kClosed = 8;

  /// Takes the lock if the bits of `mask` have the values in `expected`.
  bool take(std::uint32_t mask, std::uint32_t expected) noexcept {
    std::uint32_t seen = word_.load(std::memory_order_relaxed);
    // A failed exchange means that another thread made progress; there are only two others.
    while ((seen & mask) == expected) {
      if (word_.compare_exchange_weak(seen, seen | kLocked, std::memory_order_acquire,
                                      std::memory_order_relaxed)) {
        return true;
      }
    }
    return false;
  }

  /// Clears and sets bits in one step.
  void change(std::uint32_t clear, std::uint32_t set) noexcept {
    std::uint32_t seen = word_.load(std::memory_order_relaxed);
    while (!word_.compare_exchange_weak(seen, (seen & ~clear) | set, std::memory_order_release,
                                        std::memory_order_relaxed)) {
    }
  }

  std::atomic<std::uint32_t> word_{kClosed};
};

}  // namespace detail
}  // namespace realtime_tools
