// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstdint>

namespace realtime_tools {
namespace detail {

/// A lock around one message that also knows whose turn it is: the real-time side's, which fills
/// the message, or the publishing thread's, which sends it.
///
/// All of it is one atomic word, so that the real-time side needs no mutex. Whoever has to wait
/// sleeps on that word in the kernel (futex) and says so with `kWaiters`; whoever changes the word
/// wakes it only then. Nobody polls.
///
/// Real-time safe: tryLock, unlock, unlockAndHandOver. They never wait; the last two enter the
/// kernel for one FUTEX_WAKE (bounded, non-blocking) when a thread sleeps on the lock.
/// Not real-time safe: lock, waitForTurn. Thread-safe: all.
class TurnLock {
 public:
  /// Starts closed: tryLock() fails until open().
  TurnLock() = default;
  TurnLock(const TurnLock&) = delete;
  TurnLock& operator=(const TurnLock&) = delete;

  /// Gives the first turn to the real-time side. No other thread may use the lock meanwhile.
  void open() noexcept { word_.store(0, std::memory_order_release); }

  /// Takes the lock if it is free and it is the real-time side's turn. Never waits.
  bool tryLock() noexcept {
    std::uint32_t seen = word_.load(std::memory_order_relaxed);
    // A failed exchange means that another thread made progress; there are only two others.
    while ((seen & (kLocked | kHandedOver | kClosed)) == 0) {
      if (word_.compare_exchange_weak(seen, seen | kLocked, std::memory_order_acquire,
                                      std::memory_order_relaxed)) {
        return true;
      }
    }
    return false;
  }

  /// Takes the lock whosever turn it is; waits while another thread holds it.
  void lock() noexcept {
    std::uint32_t seen = word_.load(std::memory_order_relaxed);
    while (true) {
      if ((seen & kLocked) != 0) {
        seen = sleep(seen);
      } else if (word_.compare_exchange_weak(seen, seen | kLocked, std::memory_order_acquire,
                                             std::memory_order_relaxed)) {
        return;
      }
    }
  }

  /// Gives the lock back; the turn stays.
  void unlock() noexcept { change(kLocked, 0); }

  /// Gives the lock back and the turn to the publishing thread.
  void unlockAndHandOver() noexcept { change(kLocked, kHandedOver); }

  /// For the publishing thread: waits for its turn and takes the lock.
  /// @return false, without the lock, once stop() was called.
  bool waitForTurn() noexcept {
    std::uint32_t seen = word_.load(std::memory_order_relaxed);
    while (true) {
      if ((seen & kStopped) != 0) {
        return false;
      }
      if ((seen & (kHandedOver | kLocked)) != kHandedOver) {
        seen = sleep(seen);
      } else if (word_.compare_exchange_weak(seen, seen | kLocked, std::memory_order_acquire,
                                             std::memory_order_relaxed)) {
        return true;
      }
    }
  }

  /// For the publishing thread: gives back the lock and the turn.
  void unlockAndReturn() noexcept { change(kLocked | kHandedOver, 0); }

  /// Ends waitForTurn() for good, until the next open().
  void stop() noexcept { change(0, kStopped); }

 private:
  static constexpr std::uint32_t kLocked = 1;
  static constexpr std::uint32_t kHandedOver = 2;
  static constexpr std::uint32_t kStopped = 4;
  static constexpr std::uint32_t kClosed = 8;
  static constexpr std::uint32_t kWaiters = 16;

  /// Clears and sets bits in one step and wakes all who wait for a change.
  void change(std::uint32_t clear, std::uint32_t set) noexcept {
    std::uint32_t seen = word_.load(std::memory_order_relaxed);
    while (!word_.compare_exchange_weak(seen, (seen & ~(clear | kWaiters)) | set,
                                        std::memory_order_release, std::memory_order_relaxed)) {
    }
    if ((seen & kWaiters) != 0) {
      futex(FUTEX_WAKE_PRIVATE, INT_MAX);
    }
  }

  /// Sleeps until the word differs from `seen`. @return the word afterwards.
  std::uint32_t sleep(std::uint32_t seen) noexcept {
    const std::uint32_t announced = seen | kWaiters;
    if (seen == announced ||
        word_.compare_exchange_strong(seen, announced, std::memory_order_relaxed)) {
      futex(FUTEX_WAIT_PRIVATE, announced);
    }
    return word_.load(std::memory_order_relaxed);
  }

  void futex(int operation, std::uint32_t value) noexcept {
    // Its errors (the word has changed already, a signal came) all mean: look again.
    ::syscall(SYS_futex, reinterpret_cast<std::uint32_t*>(&word_), operation, value, nullptr,
              nullptr, 0);
  }

  std::atomic<std::uint32_t> word_{kClosed};
  static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t),
                "the kernel looks at the atomic as at a plain word");
};

}  // namespace detail
}  // namespace realtime_tools
