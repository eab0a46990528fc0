// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A millisecond of FrankaHW neither allocates nor locks.
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

}  // namespace
}  // namespace franka_hw_test
