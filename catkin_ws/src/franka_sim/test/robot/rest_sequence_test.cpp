// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// How an arm comes to rest: it brakes, and yields after a reflex.
#include "fci_fixture.h"
#include "robot/motion/motion_generator.h"

namespace franka_sim::test {

namespace {

using Joints = std::array<double, 7>;

const Joints kSwing{{0.3, 0, 0, 0, 0, 0, 0}};
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
