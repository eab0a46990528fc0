// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions by the operator: they reach what they accept, also at the ends of an FR3's joints, and
// report an arrival only there.
#include <franka_sim/robot/motion/operator_motion.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "fci_fixture.h"
#include "reach_ends.h"

namespace franka_sim::test {
namespace {

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

TEST_P(OperatorMotionTest, RefusesWhatIsBeyondTheReachOfAJointAndNamesIt) {
  for (const End& end : endsOf(unit.limits())) {
    Joints target = kReady;
    target[end.joint] = end.dead;
    const bool reached = end.dead == end.last;
    EXPECT_EQ(reached ? std::nullopt : std::optional(end.joint), motion.jointOutOfReach(target));
    if (!reached) {
      EXPECT_EQ(Status::kInvalidArgumentRejected, motion.start(target, 1.0));
    }
  }
}

// The operator's motion slows down where the velocity limit of a joint shrinks.
TEST_P(OperatorMotionTest, ReachesTheEndOfAJointExactly) {
  Joints target = kReady;
  target[0] = unit.limits().reach(0).highest;
  ASSERT_EQ(Status::kMotionStarted, motion.start(target, 1.0));
  EXPECT_LT(finish(), 20000);
  EXPECT_TRUE(motion.arrived());
  EXPECT_EQ(target, unit.state().q_d);
}

TEST_P(OperatorMotionTest, IsNotReportedAsArrivedIfARestartOrAStopEndsIt) {
  Joints target = kReady;
  target[0] += 0.1;
  ASSERT_EQ(Status::kMotionStarted, motion.start(target, 0.5));
  finish();
  ASSERT_TRUE(motion.arrived());
  for (const auto& [ticks, stops] :
       {std::pair{0, false}, std::pair{100, false}, std::pair{100, true}}) {
    run(300);
    target[0] -= 0.1;
    ASSERT_EQ(Status::kMotionStarted, motion.start(target, 0.5));
    for (int i = 0; i < ticks; i++) {
      tick();
    }
    ASSERT_TRUE(motion.active());
    if (stops) {
      motion.stop();
    } else {
      arm.put(arm.q());
      unit.restart();
    }
    tick();
    EXPECT_FALSE(motion.active()) << ticks;
    EXPECT_FALSE(motion.arrived()) << ticks;
  }
}

INSTANTIATE_TEST_SUITE_P(Protocols, OperatorMotionTest, ::testing::Values(5U, 8U, 10U));

}  // namespace
}  // namespace franka_sim::test
