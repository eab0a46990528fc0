// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The pace of simulated time and how often /clock is published.

#include "pace.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <limits>

#include "sentences.h"

namespace franka_sim_mujoco {
namespace {

TEST(Pace, RefusesInvalidFactors) {
  for (const double factor : {-1.0, 0.001, std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(contains(sentence([&] { paceOf(factor); }), "is wrong: it must be 0")) << factor;
  }
  EXPECT_EQ(franka_sim::fci::PaceMode::kFreeRunning, paceOf(0.0).mode);
  EXPECT_EQ(franka_sim::fci::PaceMode::kPatient, paceOf(kMinPace).mode);
  EXPECT_EQ(2.0, paceOf(2.0).factor);
}

TEST(Pace, PublishesTheClockLessOftenBeyondRealTime) {
  EXPECT_EQ(1000.0, clockRateOf(kMinPace));
  EXPECT_EQ(1000.0, clockRateOf(1.0));
  for (const double factor : {0.0, 1.01, 30.0}) {
    EXPECT_GE(clockRateOf(factor), 100.0) << factor;
    EXPECT_LE(clockRateOf(factor), 250.0) << factor;
  }
}

std::int64_t sleepsOfThisThread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

TEST(ShortSleeps, InterruptAThreadThatNeverWaits) {
  ShortSleeps short_sleeps;
  const std::int64_t before = sleepsOfThisThread();
  const std::int64_t end = monotonicNanoseconds() + 60000000000;
  while (sleepsOfThisThread() < before + 3 && monotonicNanoseconds() < end) {
    short_sleeps.sleepIfDue();
  }
  EXPECT_LE(before + 3, sleepsOfThisThread());
}

}  // namespace
}  // namespace franka_sim_mujoco
