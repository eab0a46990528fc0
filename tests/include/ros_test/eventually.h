// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Waits for what other threads do, in tests.

#include <chrono>
#include <thread>

namespace ros_test {

constexpr std::chrono::seconds kDeadline{30};  ///< for immediate reactions, on a busy machine

/// Polls a condition until it holds, and not again afterwards. A condition may also do work, such
/// as a cycle of a controller manager.
/// @param pause between two looks.
/// @return whether it held within the time limit.
template <class Condition>
bool eventually(Condition&& condition,
                std::chrono::microseconds pause = std::chrono::milliseconds(1),
                std::chrono::duration<double> limit = kDeadline) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(pause);  // between two looks
  }
  return true;
}

}  // namespace ros_test
