// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <semaphore.h>
#include <time.h>

#include <cerrno>
#include <cmath>

namespace franka_example_controllers {

/// Lets the control loop wake other threads, and wait for them for a limited time.
class Semaphore {
 public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() { sem_post(&semaphore_); }
  /// Forgets what was posted for an event that was seen without wait().
  void drain() {
    while (sem_trywait(&semaphore_) == 0) {
    }
  }
  void wait() {
    while (sem_wait(&semaphore_) != 0) {
    }
  }
  /// @param deadline on the monotonic clock @returns false if it has passed
  bool waitUntil(const timespec& deadline) {
    while (sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &deadline) != 0) {
      if (errno == ETIMEDOUT) {
        return false;
      }
    }
    return true;
  }

 private:
  sem_t semaphore_;
};

/// A moment on the monotonic clock. @param seconds from now
inline timespec deadlineAfter(double seconds) {
  constexpr long kSecond = 1000000000;
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const double whole = std::floor(seconds);
  now.tv_sec += static_cast<time_t>(whole);
  now.tv_nsec += static_cast<long>((seconds - whole) * kSecond);
  if (now.tv_nsec >= kSecond) {
    now.tv_nsec -= kSecond;
    now.tv_sec++;
  }
  return now;
}

}  // namespace franka_example_controllers
