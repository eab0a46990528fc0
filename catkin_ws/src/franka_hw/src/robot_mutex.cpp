// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/robot_mutex.h>

#include <chrono>
#include <thread>

namespace franka_hw {

namespace {

// Time between two attempts to lock.
constexpr std::chrono::microseconds kAttemptPeriod{100};
// Number of these periods for which the reading loop sleeps at most while there is a request.
constexpr int kMaxYields = 50;
// A thread that only reads a state holds the robot for one or two milliseconds, and longer if the
// machine is busy with other work or the robot is silent.
constexpr std::chrono::milliseconds kSoon{500};

}  // namespace

std::unique_lock<std::mutex> RobotMutex::take() {
  const Request request(*this);
  return std::unique_lock<std::mutex>(*this);
}

std::unique_lock<std::mutex> RobotMutex::takeWhile(const std::function<bool()>& reason) {
  const Request request(*this);
  std::unique_lock<std::mutex> lock(*this, std::defer_lock);
  while (reason() && !lock.try_lock()) {
    std::this_thread::sleep_for(kAttemptPeriod);
  }
  return lock;
}

std::unique_lock<std::mutex> RobotMutex::lockSoon(std::mutex& mutex,
                                                  const std::function<void()>& busy) {
  const auto deadline = std::chrono::steady_clock::now() + kSoon;
  std::unique_lock<std::mutex> lock(mutex, std::defer_lock);
  while (!lock.try_lock() && std::chrono::steady_clock::now() < deadline) {
    busy();
    std::this_thread::sleep_for(kAttemptPeriod);
  }
  return lock;
}

int RobotMutex::yieldToRequests() const {
  int yields = 0;
  do {
    std::this_thread::sleep_for(kAttemptPeriod);
    yields++;
  } while (waiting_ != 0 && yields < kMaxYields);
  return yields;
}

}  // namespace franka_hw
