// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions by the operator: they reach what they accept, also at the ends of an FR3's joints, and
// report an arrival only there.
#include <franka_sim/robot/whole_robot.h>

#include <array>
#include <cmath>
#include <string>

#include "fci_fixture.h"
#include "reach_ends.h"

namespace franka_sim::test {
namespace {

using Joints = std::array<double, 7>;

constexpr int kMaxTicks = 60000;  // [ticks]

class OperatorMotionTest : public FciTest, public ::testing::WithParamInterface<unsigned> {
 protected:
  OperatorMotionTest() {
    parameters.protocol_version = GetParam();
    rebuild();
    run(3);
  }

  void tick() {
    const RobotState& state = unit.observe(arm.measure());
    EXPECT_EQ(std::vector<int>{}, raised()) << state.q_d[0];
    arm.applyTorques(unit.actuate(motion.command()));
    arm.step();
  }

  /// Runs a motion to its end. @returns its ticks
  int finish() {
    int ticks = 0;
    while (motion.active() && ticks < kMaxTicks && raised().empty()) {
      tick();
      ticks++;
    }
    return ticks;
  }

  OperatorMotion motion{unit};
};

/// A pose from which the arm can move each joint to its ends without touching itself.
constexpr Joints kFree{{0, -0.3, 0, -1.6, 0, 2.4, 0.785398163397}};

TEST_P(OperatorMotionTest, ReachesBothEndsOfEachJointAndRefusesWhatIsBeyond) {
  for (const End& end : endsOf(unit.limits())) {
    for (const double speed : {0.3, 1.0}) {
      SCOPED_TRACE("joint " + std::to_string(end.joint + 1) + " to " + std::to_string(end.last));
      standAt(kFree);
      Joints target = kFree;
      if (end.dead != end.last) {
        target[end.joint] = end.dead;
        EXPECT_EQ(Status::kInvalidArgumentRejected, motion.start(target, speed));
        EXPECT_EQ(end.joint, motion.jointOutOfReach(target));
      }
      target[end.joint] = end.last;
      ASSERT_EQ(Status::kMotionStarted, motion.start(target, speed));
      const int ticks = finish();
      EXPECT_LT(ticks, 20000);
      EXPECT_TRUE(motion.arrived()) << ticks << " ticks, at " << unit.state().q_d[end.joint];
      EXPECT_EQ(target, unit.state().q_d);
    }
  }
}

TEST_P(OperatorMotionTest, AnArmBeyondItsReachMayStayThereAndReturn) {
  for (const End& end : endsOf(unit.limits())) {
    SCOPED_TRACE("joint " + std::to_string(end.joint + 1) + " from " + std::to_string(end.dead));
    Joints start = kFree;
    start[end.joint] = end.dead;
    standAt(start);
    Joints target = unit.state().q_d;
    target[(end.joint + 1) % 7] += 0.05;
    ASSERT_EQ(Status::kMotionStarted, motion.start(target, 0.5));
    finish();
    EXPECT_TRUE(motion.arrived());
    run(300);
    ASSERT_EQ(Status::kMotionStarted, motion.start(kFree, 0.5));
    finish();
    EXPECT_TRUE(motion.arrived());
    EXPECT_EQ(kFree, unit.state().q_d);
  }
}

TEST_P(OperatorMotionTest, IsNotReportedAsArrivedIfARestartEndsIt) {
  Joints target = kReady;
  target[0] += 0.1;
  ASSERT_EQ(Status::kMotionStarted, motion.start(target, 0.5));
  finish();
  ASSERT_TRUE(motion.arrived());
  for (const int ticks : {0, 100}) {
    run(300);
    target[0] -= 0.1;
    ASSERT_EQ(Status::kMotionStarted, motion.start(target, 0.5));
    for (int i = 0; i < ticks; i++) {
      tick();
    }
    ASSERT_TRUE(motion.active());
    arm.put(arm.q());
    unit.restart();
    tick();
    EXPECT_FALSE(motion.active()) << ticks;
    EXPECT_FALSE(motion.arrived()) << ticks;
  }
}

INSTANTIATE_TEST_SUITE_P(Protocols, OperatorMotionTest, ::testing::Values(5U, 8U, 10U));

}  // namespace
}  // namespace franka_sim::test
