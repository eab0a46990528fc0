// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "pace.h"

#include <franka_core/numbers.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <string>

namespace franka_sim_mujoco {

namespace {

constexpr double kClockRate = 1000.0;     ///< [Hz] one per tick
constexpr double kMaxClockRate = 1000.0;  ///< [Hz] (decision 22)
/// [Hz] Chosen here: the time in nodes is at most 5 ms old, and a Python node, which needs 0.1 ms
/// per message, uses a fiftieth of a processor for it.
constexpr double kFastClockRate = 200.0;

constexpr std::int64_t kMaxRunTime = 20000000;  ///< [ns]
constexpr timespec kShortSleep{0, 1000000};
/// Fewer sleeps within kMaxRunTime are contended locks, not waits for the next tick; or ticks are
/// at least 5 ms apart, and a short sleep delays none.
constexpr std::int64_t kFewSleeps = 4;

std::int64_t sleepsOfThread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

std::int64_t nanoseconds(clockid_t clock) noexcept {
  constexpr std::int64_t kNanosecondsPerSecond = 1000000000;
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
}

// Callers of the simulation's services wait meanwhile, for ten seconds at most (RequestQueue).
constexpr std::chrono::seconds kPatience{5};

}  // namespace

std::int64_t monotonicNanoseconds() noexcept { return nanoseconds(CLOCK_MONOTONIC); }

std::int64_t threadNanoseconds() noexcept { return nanoseconds(CLOCK_THREAD_CPUTIME_ID); }

void ShortSleeps::sleepIfDue() noexcept {
  const std::int64_t now = monotonicNanoseconds();
  if (now - looked_ns_ < kMaxRunTime) {
    return;
  }
  if (sleepsOfThread() - sleeps_ < kFewSleeps) {
    nanosleep(&kShortSleep, nullptr);
  }
  looked_ns_ = monotonicNanoseconds();
  sleeps_ = sleepsOfThread();
}

franka_sim::fci::Pace paceOf(double real_time_factor) {
  if (!std::isfinite(real_time_factor) || real_time_factor < 0.0 ||
      (real_time_factor > 0.0 && real_time_factor < kMinPace)) {
    throw std::runtime_error("The real time factor " + franka_core::numberText(real_time_factor) +
                             " is wrong: it must be 0 (as fast as possible) or at least " +
                             franka_core::numberText(kMinPace) + ".");
  }
  franka_sim::fci::Pace pace;
  pace.mode = real_time_factor > 0.0 ? franka_sim::fci::PaceMode::kPatient
                                     : franka_sim::fci::PaceMode::kFreeRunning;
  pace.factor = real_time_factor;
  pace.patience = kPatience;
  return pace;
}

double clockRateOf(double real_time_factor) noexcept {
  return real_time_factor > 0.0 && real_time_factor <= 1.0 ? kClockRate : kFastClockRate;
}

namespace {

constexpr std::int64_t kStandStillInterval = 100000000;  // [ns]
/// Chosen here: eleven days; sums of slower rates would leave the range of 64 bits.
constexpr double kMaxInterval = 1e15;  // [ns]

}  // namespace

ClockPublisher::ClockPublisher(ros::NodeHandle& node) : publisher_(node, "/clock", 10) {}

void ClockPublisher::setRate(double rate) {
  interval_ns_ = std::llround(std::min(1e9 / rate, kMaxInterval));
}

void ClockPublisher::tick(const ros::Time& time) {
  const std::int64_t now = monotonicNanoseconds();
  // Tolerance of half an interval: a tick that is slightly early must not lose its message. The
  // bookkeeping below keeps the mean at one message per interval.
  if (now + interval_ns_ / 2 < next_ns_ || !publisher_.trylock()) {
    return;
  }
  publisher_.msg_.clock = time;
  publisher_.unlockAndPublish();
  next_ns_ = std::max(next_ns_, now - interval_ns_) + interval_ns_;
  published_ = time;
  published_ns_ = now;
}

void ClockPublisher::standStill(const ros::Time& time) {
  const std::int64_t now = monotonicNanoseconds();
  if (time == published_ && now - published_ns_ < kStandStillInterval) {
    return;
  }
  if (publisher_.trylock()) {
    publisher_.msg_.clock = time;
    publisher_.unlockAndPublish();
    published_ = time;
    published_ns_ = now;
  }
}

SimulationPace::SimulationPace(double factor, double clock_rate, franka_sim::fci::Host& host,
                               franka_sim::World& world, ClockPublisher& clock)
    : host_(host), world_(world), clock_(clock), factor_(factor), clock_rate_(clock_rate) {
  if (!std::isfinite(clock_rate_) || clock_rate_ < 0.0 || clock_rate_ > kMaxClockRate) {
    throw std::runtime_error("The clock rate " + franka_core::numberText(clock_rate_) +
                             " Hz is wrong: it must be 0 (as fits the real time factor), or above "
                             "it and at most " +
                             std::to_string(static_cast<int>(kMaxClockRate)) + " Hz.");
  }
  apply();
}

void SimulationPace::setFactor(double factor) {
  paceOf(factor);  // throws for an invalid factor
  factor_ = factor;
  apply();
}

void SimulationPace::review(bool starting) {
  if (starting != starting_) {
    starting_ = starting;
    apply();
  }
}

void SimulationPace::apply() {
  const bool held = starting_ && (factor_ == 0.0 || factor_ > 1.0);
  const double factor = held ? 1.0 : factor_;
  host_.setPace(paceOf(factor));
  world_.setPreparesBeside(factor == 0.0);
  clock_.setRate(clock_rate_ > 0.0 ? clock_rate_ : clockRateOf(factor));
}

}  // namespace franka_sim_mujoco
