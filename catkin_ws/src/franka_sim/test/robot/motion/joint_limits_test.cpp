// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The ends of the joints' ranges, and the velocity limits near them. Limits of the derivatives:
// motion_limits_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion_fixture.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

TEST(JointLimits, PositionsEndAtTheRangeWithTheFlagOfTheSystem) {
  for (const auto& [protocol, flag] :
       {std::pair{5U, RobotError::kJointMotionGeneratorPositionLimitsViolation},
        std::pair{8U, RobotError::kJointMotionGeneratorPositionLimitsViolation},
        std::pair{9U, RobotError::kJointPositionLimitsViolation},
        std::pair{10U, RobotError::kJointPositionLimitsViolation}}) {
    const franka_core::MotionLimits limits = franka_core::motionLimitsOfProtocol(protocol);
    for (std::size_t joint = 0; joint < 7; joint++) {
      SCOPED_TRACE(::testing::Message() << "protocol " << protocol << ", joint " << joint + 1);
      for (const double end : {limits.arm.q_min[joint], limits.arm.q_max[joint]}) {
        Joints q = kReady;
        const double outwards =
            end > 0.5 * (limits.arm.q_min[joint] + limits.arm.q_max[joint]) ? 1 : -1;
        q[joint] = end - outwards * 4e-4;
        Motion motion(protocol, MotionGeneratorMode::kJointPosition, q);
        q[joint] = end;
        EXPECT_FALSE(motion.step(jointPositions(q)).errors);
        q[joint] = end + outwards * 1e-6;  // more than a float's rounding
        ErrorSet expected = flag;
        // Where an FR3's speed limit has shrunk to nothing, this is too fast as well.
        const double speed_limit =
            outwards > 0 ? limits.highestVelocity(joint, end) : -limits.lowestVelocity(joint, end);
        expected.addIf(speed_limit < 1e-6 / kTick,
                       RobotError::kJointMotionGeneratorVelocityLimitsViolation);
        EXPECT_EQ(expected, motion.step(jointPositions(q)).errors);
      }
    }
  }
}

TEST(JointLimits, BeyondTheRangeOnlyMotionBackIsAllowed) {
  Joints q = kReady;
  q[0] = 2.91;
  for (const double direction : {-1.0, 1.0}) {
    Motion motion(5, MotionGeneratorMode::kJointPosition, q);
    EXPECT_FALSE(motion.step(jointPositions(q)).errors);
    Joints next = q;
    next[0] += direction * 5e-6;
    EXPECT_EQ(direction > 0.0, bool(motion.step(jointPositions(next)).errors));
  }
}

TEST(JointLimits, SpeedLimitOfAnFr3ShrinksTowardsTheEnds) {
  for (unsigned protocol : {8U, 10U}) {
    const franka_core::MotionLimits limits = franka_core::motionLimitsOfProtocol(protocol);
    for (std::size_t joint = 0; joint < 7; joint++) {
      SCOPED_TRACE(::testing::Message() << "protocol " << protocol << ", joint " << joint + 1);
      // Closed form, 0.3 rad before the end (protocol 5.5).
      const auto& near = limits.velocity_near_ends;
      const double limit = std::sqrt(near.deceleration[joint] * 0.3) - near.offset[joint];
      const double shrunk = 0.5 * near.deceleration[joint] * kTick;  // at most, in a tick
      for (const double sign : {-1.0, 1.0}) {
        Joints q = kReady;
        q[joint] = sign > 0.0 ? near.q_max[joint] - 0.3 : near.q_min[joint] + 0.3;
        const auto limit_at = [&](double q) {
          return sign > 0.0 ? limits.highestVelocity(joint, q) : -limits.lowestVelocity(joint, q);
        };
        EXPECT_NEAR(limit, limit_at(q[joint]), 1e-12);
        Motion motion(protocol, MotionGeneratorMode::kJointVelocity, q);
        Joints dq{};
        ErrorSet fault;
        while (!fault && std::abs(dq[joint]) < 2.0) {
          dq[joint] += sign * 4e-3;  // jerk-limited steps in turn: 4 rad/s^2
          fault = motion.step(jointVelocities(dq)).errors;
        }
        EXPECT_EQ(RobotError::kJointMotionGeneratorVelocityLimitsViolation, fault);
        EXPECT_GT(sign * dq[joint], limit_at(motion.desired().q_d[joint]));
        EXPECT_LT(sign * dq[joint], limit_at(motion.desired().q_d[joint]) + 4e-3 + shrunk);
      }
    }
  }
}

}  // namespace

}  // namespace franka_sim::test
