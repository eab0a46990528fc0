// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/stepping/preparation_thread.h"

#include <sched.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace franka_sim::physics {

namespace {

/// Time between two checks for a request while it does not pay to wait without sleep: at first
/// after a short interruption of the stepping thread, and at last. Chosen here: 50 wake-ups per
/// second take 0.3 % of a slow processor.
constexpr std::chrono::milliseconds kMinSleep{1};
constexpr std::chrono::milliseconds kMaxSleep{20};

/// Checks of a running preparation before the stepping thread yields its processor, which the
/// preparation may need. Chosen here: they take longer than a preparation for a few arms.
constexpr int kChecks = 2000;

}  // namespace

PreparationThread::PreparationThread(std::function<void()> prepare)
    : prepare_(std::move(prepare)), thread_([this] { run(); }) {}

PreparationThread::~PreparationThread() {
  ends_ = true;
  thread_.join();
}

void PreparationThread::run() {
  using Clock = franka_core::SpinRule::Clock;
  while (!ends_.load(std::memory_order_relaxed)) {
    if (spin_rule_.spin([this] { return takeRequest(); })) {
      prepare_();
      state_.store(State::kIdle, std::memory_order_release);
      continue;
    }
    const unsigned requests = requests_.load(std::memory_order_relaxed);
    Clock::duration sleep =
        std::clamp<Clock::duration>(spin_rule_.pauseLeft(Clock::now()), kMinSleep, kMaxSleep);
    // While the world is not stepped, the thread has nothing to wait for, and SpinRule nothing to
    // measure.
    do {
      std::this_thread::sleep_for(sleep);
      sleep = std::min<Clock::duration>(2 * sleep, kMaxSleep);
    } while (requests == requests_.load(std::memory_order_relaxed) &&
             !ends_.load(std::memory_order_relaxed));
  }
}

bool PreparationThread::takeRequest() noexcept {
  State expected = State::kRequested;
  return state_.load(std::memory_order_relaxed) == expected &&
         state_.compare_exchange_strong(expected, State::kRunning, std::memory_order_acquire,
                                        std::memory_order_relaxed);
}

void PreparationThread::cancelOrWait() noexcept {
  State expected = State::kRequested;
  if (state_.compare_exchange_strong(expected, State::kIdle, std::memory_order_acquire)) {
    return;
  }
  for (int check = 0; state_.load(std::memory_order_acquire) != State::kIdle; ++check) {
    if (check >= kChecks) {
      sched_yield();
    }
  }
}

}  // namespace franka_sim::physics
