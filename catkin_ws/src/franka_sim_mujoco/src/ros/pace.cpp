// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/ros/pace.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>

namespace franka_sim_mujoco {

namespace {

constexpr double kClockRate = 1000.0;  ///< [Hz] a tick each
/// [Hz] Chosen here: eight arms with their nodes then spend a tenth of a processor on it
/// (docs/performance.md), and no node hears of the time more than 5 ms late.
constexpr double kFastClockRate = 200.0;

std::int64_t nanoseconds(clockid_t clock) noexcept {
  constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
}

// Who asks something of the simulation waits meanwhile, for ten seconds at most (RequestQueue).
constexpr std::chrono::seconds kPatience{5};

}  // namespace

std::int64_t monotonicNanoseconds() noexcept { return nanoseconds(CLOCK_MONOTONIC); }

std::int64_t threadNanoseconds() noexcept { return nanoseconds(CLOCK_THREAD_CPUTIME_ID); }

fci::Pace paceOf(double real_time_factor) {
  if (!std::isfinite(real_time_factor) || real_time_factor < 0.0 ||
      (real_time_factor > 0.0 && real_time_factor < kSlowestPace)) {
    throw std::runtime_error("The real time factor " + std::to_string(real_time_factor) +
                             " is wrong: it must be 0 (as fast as possible) or at least " +
                             std::to_string(kSlowestPace) + ".");
  }
  fci::Pace pace;
  pace.lockstep = pace.flows = true;
  pace.by_clock = real_time_factor > 0.0;
  pace.factor = real_time_factor;
  pace.patience = kPatience;
  return pace;
}

double clockRateOf(double real_time_factor) noexcept {
  return real_time_factor > 0.0 && real_time_factor <= 1.0 ? kClockRate : kFastClockRate;
}

}  // namespace franka_sim_mujoco
