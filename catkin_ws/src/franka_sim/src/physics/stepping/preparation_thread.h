// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/spin_rule.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

namespace franka_sim::physics {

/// Prepares the next step on a thread of its own while the stepping thread computes something else,
/// so that a tick takes less time (decision 62).
///
/// Neither thread waits for the other one to wake up. This thread checks for requests without sleep
/// while SpinRule recommends that, and the stepping thread cancels a request that has not begun.
/// One stepping thread at a time calls request() and finish().
class PreparationThread {
 public:
  /// @param prepare must not throw. Not real-time safe.
  explicit PreparationThread(std::function<void()> prepare);
  ~PreparationThread();
  PreparationThread(const PreparationThread&) = delete;
  PreparationThread& operator=(const PreparationThread&) = delete;

  /// Asks for one call of `prepare`. Real-time safe.
  void request() noexcept {
    requests_.store(requests_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    state_.store(State::kRequested, std::memory_order_release);
  }
  /// Returns when nothing is being prepared and nothing is requested any more; what `prepare` wrote
  /// is visible then. Real-time safe.
  void finish() noexcept {
    if (state_.load(std::memory_order_acquire) != State::kIdle) {
      cancelOrWait();
    }
  }

 private:
  enum class State { kIdle, kRequested, kRunning };

  void run();
  bool takeRequest() noexcept;
  void cancelOrWait() noexcept;

  std::function<void()> prepare_;
  std::atomic<State> state_{State::kIdle};
  std::atomic<unsigned> requests_{0};  ///< so far
  std::atomic<bool> ends_{false};
  /// Other threads of this process, which publish and serve, mostly interrupt this one for shorter
  /// times, other programs for longer ones (chosen here).
  static constexpr std::chrono::microseconds kGap{100};

  franka_core::SpinRule spin_rule_{franka_core::WaitMode::kAuto, franka_core::hasTwoProcessors(),
                                   kGap};
  std::thread thread_;
};

}  // namespace franka_sim::physics
