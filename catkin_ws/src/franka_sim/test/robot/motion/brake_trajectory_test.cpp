// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// How the desired motion brakes, and yields after a reflex.
#include "robot/motion/brake_trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion_fixture.h"
#include "robot/motion/rest_sequence.h"

namespace franka_sim::test {

namespace {

TEST(BrakeTrajectory, StopsEachJointAtItsFullAccelerationWithinItsJerkLimit) {
  const auto& arm = franka_core::kFerLimits;
  Joints dq = arm.dq;
  dq[2] = -dq[2];
  dq[4] = 0.0;
  BrakeTrajectory brake;
  brake.start(kReady, dq, {}, arm);
  EXPECT_FALSE(brake.atRest());
  int ticks = 0;
  for (; !brake.atRest(); ticks++) {
    ASSERT_LT(ticks, 1000);
    const Joints before = brake.q();
    const Joints ddq_before = brake.ddq();
    brake.step();
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_LE(std::abs(brake.ddq()[i]), arm.ddq[i] * (1 + 1e-9));
      EXPECT_LE(std::abs(brake.ddq()[i] - ddq_before[i]), arm.dddq[i] * kTick * (1 + 1e-9));
      EXPECT_NEAR((brake.q()[i] - before[i]) / kTick, brake.dq()[i], 1e-12);
      EXPECT_GE(brake.dq()[i] * dq[i], 0.0);  // never reverses
    }
  }
  // Joint 2 takes longest: at half of its acceleration in its first and in its last tick, and a
  // tick more until its acceleration has ended, too.
  EXPECT_EQ(static_cast<int>(std::ceil(2.175 / 7.5 / kTick)) + 2, ticks);
  for (std::size_t i = 0; i < 7; i++) {
    const double ramp = arm.ddq[i] / arm.dddq[i];
    const double way = 0.5 * dq[i] * (std::abs(dq[i]) / arm.ddq[i] + 0.5 * ramp);
    EXPECT_NEAR(kReady[i] + way, brake.q()[i], 0.5 * std::abs(dq[i]) * kTick + 1e-12);
  }
  brake.step();
  EXPECT_EQ(Joints{}, brake.ddq());
  brake.start(kReady, {{NAN, 0, 0, 0, 0, 0, 0}}, {}, arm);
  EXPECT_TRUE(brake.atRest());
}

TEST(BrakeTrajectory, ContinuesTheAccelerationOfTheMotion) {
  const auto& arm = franka_core::kFr3Limits;
  BrakeTrajectory brake;
  brake.start(kReady, {{1, 1, 0, 0, 0, 0, 0}}, {{10, -10, 0, 0, 0, 0, 0}}, arm);
  brake.step();
  EXPECT_NEAR(5, brake.ddq()[0], 1e-9);
  EXPECT_NEAR(-10, brake.ddq()[1], 1e-9);
}

const franka_core::ArmLimits kLimits = franka_core::kFr3Limits;

TEST(RestSequence, YieldsForTwoHundredTicksAfterAReflex) {
  RestSequence rest;
  rest.brake(kReady, {}, {}, kLimits);
  EXPECT_EQ(RestSequence::Step::kStops, rest.step(true, kReady, {}, kLimits));
  int yielded = 0;
  while (rest.step(true, kReady, {}, kLimits) == RestSequence::Step::kYields) {
    ASSERT_LT(++yielded, 1000);
  }
  EXPECT_EQ(200, yielded);
  EXPECT_TRUE(rest.isFinished());
}

TEST(RestSequence, BrakesAgainFromTheMeasuredMotionWhenAReflexTakesTooLong) {
  franka_core::ArmLimits slow = kLimits;
  slow.ddq.fill(1);
  Joints met = kReady;
  met[0] += 0.01;
  RestSequence rest;
  rest.brake(kReady, {{0.5, 0, 0, 0, 0, 0, 0}}, {}, slow);  // takes 500 ms
  for (int i = 0; i < 199; i++) {
    EXPECT_EQ(RestSequence::Step::kBrakes, rest.step(true, met, {}, slow));
  }
  EXPECT_GT(rest.braking().q()[0], met[0]);
  EXPECT_EQ(RestSequence::Step::kStops, rest.step(true, met, {}, slow));
  EXPECT_EQ(met, rest.braking().q());
}

}  // namespace

}  // namespace franka_sim::test
