// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/spin_rule.h>
#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace franka_core {

namespace {

using Duration = SpinRule::Clock::duration;

// Chosen here by measurement (decision 53).
constexpr Duration kTrial = std::chrono::milliseconds(8);        // without sleep
constexpr Duration kMaxLostTime = std::chrono::milliseconds(2);  // of kTrial
constexpr int kMaxWaitsWithoutAnswer = 5;                        // waits in a row
constexpr int kPauseOfTrial = 32;                                // pause over the trial before it
constexpr Duration kMaxPause = std::chrono::seconds(2);

// More time than this between two waits is not part of the exchange: the program had other work, or
// no motion ran.
constexpr Duration kMaxWork = std::chrono::milliseconds(1);
constexpr Duration kMaxStep = std::chrono::milliseconds(50);

constexpr const char* kWaitVariable = "FRANKA_WAIT";

}  // namespace

std::optional<WaitMode> toWaitMode(const std::string& text) {
  if (text == "auto") {
    return WaitMode::kAuto;
  }
  if (text == "spin") {
    return WaitMode::kSpin;
  }
  if (text == "block") {
    return WaitMode::kBlock;
  }
  return std::nullopt;
}

WaitMode waitModeOfEnvironment() {
  const char* variable = std::getenv(kWaitVariable);
  const std::string text = variable != nullptr ? variable : "";
  const std::optional<WaitMode> mode = toWaitMode(text.empty() ? "auto" : text);
  if (!mode) {
    throw std::invalid_argument(std::string("The environment variable ") + kWaitVariable +
                                " is \"" + text +
                                "\", but must be spin, block or auto. It says how a program waits "
                                "for a simulated robot (on a loopback address) in lock-step; "
                                "without it: auto.");
  }
  return *mode;
}

bool hasTwoProcessors() noexcept {
  cpu_set_t processors;
  CPU_ZERO(&processors);
  // Fails on machines with more processors than the set has places for.
  return sched_getaffinity(0, sizeof(processors), &processors) != 0 || CPU_COUNT(&processors) > 1;
}

bool SpinRule::begins(Clock::time_point now) noexcept {
  return mode_ == WaitMode::kSpin || (mode_ == WaitMode::kAuto && now >= resume_at_);
}

void SpinRule::conclude(Clock::time_point begin, Clock::time_point end, Duration away,
                        bool answered) noexcept {
  if (mode_ != WaitMode::kAuto) {
    return;
  }
  const Duration length = end - begin;
  const bool is_first = passed_ == Duration{};
  const Duration between = is_first ? Duration{} : begin - ended_at_;
  // After a wait without an answer the thread has slept.
  awake_ += length + (without_answer_ == 0 ? std::min(between, kMaxWork) : Duration{});
  passed_ += length + std::min(between, kMaxStep);
  lost_ += answered ? away : length;
  without_answer_ = answered ? 0 : without_answer_ + 1;
  ended_at_ = end;
  if (lost_ >= kMaxLostTime || without_answer_ >= kMaxWaitsWithoutAnswer) {
    resume_at_ = end + std::min(kPauseOfTrial * passed_, kMaxPause);
    without_answer_ = 0;
    beginTrial();
  } else if (awake_ >= kTrial) {
    beginTrial();
  }
}

void SpinRule::beginTrial() noexcept { awake_ = lost_ = passed_ = Duration{}; }

}  // namespace franka_core
