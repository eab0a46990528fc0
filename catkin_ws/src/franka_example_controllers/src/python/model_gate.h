// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

#include <atomic>

namespace franka_example_controllers {

/// Lets a script's thread use the arm's model only while the control loop waits for it: the model
/// and its state belong to the loop.
class ModelGate {
 public:
  /// From the loop.
  void open() { state_.store(State::kOpen, std::memory_order_release); }

  /// From the loop. Waits for a running function of the model, which takes some microseconds.
  void close() {
    constexpr timespec kMoment{0, 5000};
    State expected = State::kOpen;
    while (!state_.compare_exchange_strong(expected, State::kClosed) &&
           expected != State::kClosed) {
      // Sleeps, so that a thread of lower priority can finish.
      nanosleep(&kMoment, nullptr);
      expected = State::kOpen;
    }
  }

  /// From the script's thread. @returns false if the model may not be used
  bool enter() {
    State expected = State::kOpen;
    return state_.compare_exchange_strong(expected, State::kUsed);
  }

  void leave() { state_.store(State::kOpen, std::memory_order_release); }

 private:
  enum class State { kClosed, kOpen, kUsed };
  std::atomic<State> state_{State::kClosed};
};

}  // namespace franka_example_controllers
