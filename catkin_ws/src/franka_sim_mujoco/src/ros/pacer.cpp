// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/ros/pacer.h>

#include <cmath>
#include <ctime>

namespace franka_sim_mujoco {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
constexpr std::int64_t kForgivenDelay = 50000000;  // [ns] (our choice)
constexpr double kTickNanoseconds = 1e6;

std::int64_t nanoseconds(clockid_t clock) noexcept {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
}

}  // namespace

std::int64_t monotonicNanoseconds() noexcept { return nanoseconds(CLOCK_MONOTONIC); }

std::int64_t threadNanoseconds() noexcept { return nanoseconds(CLOCK_THREAD_CPUTIME_ID); }

bool Pacer::setFactor(double factor) noexcept {
  if (!std::isfinite(factor) || factor < 0.0 || (factor > 0.0 && factor < kSlowest)) {
    return false;
  }
  factor_ = factor;
  restart();
  return true;
}

void Pacer::restart() noexcept { deadline_ns_ = monotonicNanoseconds(); }

void Pacer::waitForNextTick() noexcept {
  if (factor_ == 0.0) {
    return;
  }
  deadline_ns_ += std::llround(kTickNanoseconds / factor_);
  const std::int64_t now = monotonicNanoseconds();
  if (now - deadline_ns_ > kForgivenDelay) {
    deadline_ns_ = now;
    return;
  }
  const timespec deadline{static_cast<time_t>(deadline_ns_ / kNanosecondsPerSecond),
                          static_cast<long>(deadline_ns_ % kNanosecondsPerSecond)};
  // An interrupted sleep (a signal) only makes this one tick early; the next deadline is
  // unaffected.
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr);
}

}  // namespace franka_sim_mujoco
