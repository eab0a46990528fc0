// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The first command of a motion, and the first one after lost commands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion_fixture.h"
#include "robot/motion/motion_generator.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

TEST(MotionStart, SingularPoseRefusesCartesianMotionsOnly) {
  MotionGenerator generator;
  MotionStart start;  // q_d is zero: the arm stretched up
  for (const auto& [mode, result] :
       {std::pair{MotionGeneratorMode::kJointPosition, MotionStartResult::kStarted},
        std::pair{MotionGeneratorMode::kJointVelocity, MotionStartResult::kStarted},
        std::pair{MotionGeneratorMode::kCartesianPosition, MotionStartResult::kSingular},
        std::pair{MotionGeneratorMode::kCartesianVelocity, MotionStartResult::kSingular}}) {
    start.mode = mode;
    EXPECT_EQ(result, generator.start(start, model()));
  }
}

TEST(MotionStart, FirstCommandMustEqualTheDesiredPosition) {
  for (const double offset : {0.99e-3, -0.99e-3, 1.01e-3, -1.01e-3}) {
    const bool far = std::abs(offset) > 1e-3;
    Joints q = kReady;
    q[5] += offset;
    Motion joints(5, MotionGeneratorMode::kJointPosition);
    EXPECT_EQ(
        far ? ErrorSet(RobotError::kJointPositionMotionGeneratorStartPoseInvalid) : ErrorSet(),
        joints.step(jointPositions(q)).errors);
    Motion cartesian(5, MotionGeneratorMode::kCartesianPosition);
    EXPECT_EQ(
        far ? ErrorSet(RobotError::kCartesianPositionMotionGeneratorStartPoseInvalid) : ErrorSet(),
        cartesian.step(pose(shifted(offset))).errors);
    if (!far) {  // the history starts there, at rest
      EXPECT_EQ(q, joints.desired().q_d);
      EXPECT_EQ(Joints{}, joints.desired().dq_d);
      EXPECT_EQ(Joints{}, cartesian.desired().dq_d);
      EXPECT_FALSE(joints.step(jointPositions(q)).errors);
      EXPECT_FALSE(cartesian.step(pose(shifted(offset))).errors);
    }
    Motion elbow(5, MotionGeneratorMode::kCartesianPosition);
    EXPECT_EQ(far ? ErrorSet(RobotError::kCartesianMotionGeneratorStartElbowInvalid) : ErrorSet(),
              elbow.step(withElbow(pose(startPose()), kReady[2] + offset)).errors);
    Motion twisting(5, MotionGeneratorMode::kCartesianVelocity);
    EXPECT_EQ(far ? ErrorSet(RobotError::kCartesianMotionGeneratorStartElbowInvalid) : ErrorSet(),
              twisting.step(withElbow(twist({}), kReady[2] + offset)).errors);
  }
}

TEST(ResumeTrap, ResumingFromTheOwnLastCommandAfterALossIsRefused) {
  for (int lost = 1; lost <= 19; lost++) {
    for (const bool from_the_state : {false, true}) {
      Motion motion(5, MotionGeneratorMode::kJointPosition);
      Joints q = kReady;
      double v = 0.0;
      for (int tick = 0; tick < 400; tick++) {
        v = std::min(v + 1e-3, 0.3);
        q[0] += v * kTick;
        ASSERT_FALSE(tick > 0 && motion.step(jointPositions(q)).errors);
        if (tick == 0) {
          ASSERT_FALSE(motion.step(jointPositions(q)).errors);
        }
      }
      for (int i = 0; i < lost; i++) {
        ASSERT_FALSE(motion.lose().errors);
      }
      q[0] = (from_the_state ? motion.desired().q_d[0] : q[0]) + v * kTick;
      const ErrorSet fault = motion.step(jointPositions(q)).errors;
      // Resumed at its own last command, it jumps by 0.3 mrad per lost tick: 300 rad/s^2 and more.
      // One lost command needs no speed beyond the limit, ten do (3 rad/s backwards).
      ErrorSet jump = setOf({RobotError::kJointMotionGeneratorVelocityDiscontinuity,
                             RobotError::kJointMotionGeneratorAccelerationDiscontinuity});
      jump.addIf(lost >= 9, RobotError::kJointMotionGeneratorVelocityLimitsViolation);
      EXPECT_EQ(from_the_state ? ErrorSet() : jump, fault) << lost;
    }
  }
}

}  // namespace

}  // namespace franka_sim::test
