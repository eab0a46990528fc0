// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One cycle of FrankaHW neither allocates nor locks.
#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include "bare_cycle.h"

namespace franka_hw_test {
namespace {

TEST(Cycle, NeitherAllocatesNorLocks) {
  BareCycle robot;
  ASSERT_TRUE(robot.running());
  robot.cycle();
  const rt_guard::Scope scope;
  for (int i = 0; i < 1000; i++) {
    robot.cycle();
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

TEST(Cycle, IsMeasuredFromTheStateToTheCommand) {
  FakeArm arm;
  franka_hw::FrankaHW robot;
  ASSERT_TRUE(robot.init(arm.nh, arm.robot_nh));
  Loop loop(robot, arm);
  loop.controller("JT+JP").fault = TestController::Fault::kSleep;  // two milliseconds
  ASSERT_TRUE(loop.switchTo({"JT+JP"}, {}));
  const std::atomic<int>& updates = loop.controller("JT+JP").updates_since_start;
  ASSERT_TRUE(eventually([&] { return updates > 5; }));
  const int earliest = updates;
  robot.responseTimes().take();
  const int first = updates;
  ASSERT_TRUE(eventually([&] { return updates >= first + 20; }));
  const franka_hw::ResponseTimes::Report report = robot.responseTimes().take();
  // Counted once for the two callbacks of a cycle.
  EXPECT_GE(report.cycles, 18u);
  EXPECT_LE(report.cycles, static_cast<std::uint64_t>(updates - earliest + 1));
  EXPECT_GE(report.mean, 2e-3);
  EXPECT_GE(report.longest, report.mean);
  EXPECT_GT(report.spread, 0.0);
}

}  // namespace
}  // namespace franka_hw_test
