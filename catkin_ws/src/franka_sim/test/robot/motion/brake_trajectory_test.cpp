// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// How the desired motion brakes.
#include <franka_sim/robot/motion/motion_generator.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion_fixture.h"

namespace franka_sim::test {

namespace {

TEST(BrakeTrajectory, StopsEachJointAtItsFullAcceleration) {
  const auto& arm = franka_core::kFerLimits;
  Joints dq = arm.dq;
  dq[2] = -dq[2];
  dq[4] = 0.0;
  BrakeTrajectory brake;
  brake.start(kReady, dq, arm.ddq);
  EXPECT_FALSE(brake.atRest());
  int ticks = 0;
  for (; !brake.atRest(); ticks++) {
    ASSERT_LT(ticks, 1000);
    const Joints before = brake.q();
    brake.step();
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_LE(std::abs(brake.ddq()[i]), arm.ddq[i] * (1 + 1e-12));
      EXPECT_NEAR((brake.q()[i] - before[i]) / kTick, brake.dq()[i], 1e-12);
      EXPECT_GE(brake.dq()[i] * dq[i], 0.0);  // never reverses
    }
  }
  EXPECT_EQ(static_cast<int>(std::ceil(2.175 / 7.5 / kTick)), ticks);  // joint 2 takes longest
  for (std::size_t i = 0; i < 7; i++) {
    const double way = std::copysign(0.5 * dq[i] * dq[i] / arm.ddq[i], dq[i]);
    EXPECT_NEAR(kReady[i] + way, brake.q()[i], 0.5 * std::abs(dq[i]) * kTick + 1e-12);
  }
  brake.step();
  EXPECT_EQ(Joints{}, brake.ddq());
  brake.start(kReady, {{NAN, 0, 0, 0, 0, 0, 0}}, arm.ddq);
  EXPECT_TRUE(brake.atRest());
}

}  // namespace

}  // namespace franka_sim::test
