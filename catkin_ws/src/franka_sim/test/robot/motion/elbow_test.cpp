// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Elbows, and the joints that Cartesian motions need.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "motion_fixture.h"
#include "robot/motion/joint_motion.h"
#include "robot/motion/motion_generator.h"
#include "robot/transforms.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

TEST(Elbow, HasAPositiveSignFromTheFlipOfJoint4On) {
  const double flip = franka_core::kElbowFlip;
  for (const auto& [q4, sign] : {std::pair{flip - 1e-9, -1.0}, {flip, 1.0}, {flip + 1e-9, 1.0}}) {
    EXPECT_EQ((std::array<double, 2>{0.3, sign}), elbowOf({{0, 0, 0.3, q4, 0, 0, 0}})) << q4;
  }
}

TEST(Elbow, MovesTheArmWithoutMovingTheHand) {
  Motion motion(5, MotionGeneratorMode::kCartesianPosition);
  for (int tick = 0; tick <= 1000; tick++) {
    const double q3 = 0.1 * (1.0 - std::cos(3.14159265 * tick * kTick));
    const MotionStep step = motion.step(withElbow(pose(startPose()), q3));
    ASSERT_FALSE(step.errors) << step.errors << " in tick " << tick;
    EXPECT_NEAR(q3, motion.desired().q_d[2], 1e-12);
    EXPECT_NEAR(q3, motion.desired().elbow_c[0], 1e-15);
    EXPECT_NEAR(startPose()[13], motion.desired().O_T_EE_d[13], 1e-12);
  }
  EXPECT_NEAR(0.2, motion.desired().elbow_d[0], 1e-9);
  EXPECT_GT(std::abs(motion.desired().q_d[0] - kReady[0]), 0.05);
  // Without a command the elbow stays where it was commanded last.
  EXPECT_FALSE(motion.step(pose(startPose())).errors);
  EXPECT_NEAR(0.2, motion.desired().elbow_c[0], 1e-9);
}

TEST(Elbow, MustKeepItsSignAndBeFinite) {
  for (const double sign : {1.0, 0.0, 0.5, static_cast<double>(NAN)}) {
    Motion motion(5, MotionGeneratorMode::kCartesianPosition);
    EXPECT_EQ(RobotError::kCartesianMotionGeneratorElbowSignInconsistent,
              motion.step(withElbow(pose(startPose()), kReady[2], sign)).errors);
  }
  Motion motion(5, MotionGeneratorMode::kCartesianPosition);
  EXPECT_EQ(RobotError::kCartesianMotionGeneratorElbowLimitViolation,
            motion.step(withElbow(pose(startPose()), NAN)).errors);
}

TEST(SolvedJoints, HaveThreeAndAHalfTimesTheJerkLimit) {
  for (const auto& [acceleration, fault] :
       {std::pair{12.5, ErrorSet()},
        std::pair{14.0,
                  ErrorSet(RobotError::kCartesianMotionGeneratorJointAccelerationDiscontinuity)}}) {
    // From -a to +a in one tick: 25 000 and 28 000 rad/s^3, of 3.5 * 7500.
    const franka_core::MotionLimits limits = franka_core::motionLimitsOfProtocol(5);
    JointMotion motion;
    motion.start(kReady);
    Joints q = kReady;
    ASSERT_FALSE(motion.takeSolved(q, true, limits));
    double v = 0.0;
    ErrorSet last;
    for (const double a : {-acceleration, -acceleration, acceleration}) {
      ASSERT_FALSE(last);
      v += a * kTick;
      q[0] += v * kTick;
      last = motion.takeSolved(q, false, limits);
    }
    EXPECT_EQ(fault, last);
  }
}

}  // namespace

}  // namespace franka_sim::test
