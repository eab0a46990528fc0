// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The generators as a whole: starts, states, lost commands, finishing, the elbow.
#include "robot/motion/motion_generator.h"

#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "motion_fixture.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

using franka_core::ArmFrame;

constexpr double kPi = 3.14159265358979323846;

/// A smooth path from 0 to 1 in one second and its derivative.
double way(double t) { return 0.5 * (1.0 - std::cos(kPi * std::min(t, 1.0))); }

/// The hand's frame moved by 5 cm and turned by 0.2 rad, by share s.
Transform movedBy(double s) {
  Transform result = forward(kReady);
  Eigen::Map<Eigen::Matrix4d> matrix(result.data());
  matrix.topRightCorner<3, 1>() += s * Eigen::Vector3d(0.03, -0.02, 0.04);
  const Eigen::AngleAxisd turn(0.2 * s, Eigen::Vector3d(1, 2, -2) / 3.0);
  matrix.topLeftCorner<3, 3>() = Eigen::Matrix3d(turn * matrix.topLeftCorner<3, 3>());
  return result;
}

Twist twistAt(double t) {
  const double rate = 0.5 * kPi * std::sin(kPi * std::min(t, 1.0));
  return {
      {0.03 * rate, -0.02 * rate, 0.04 * rate, 0.2 / 3 * rate, 0.4 / 3 * rate, -0.4 / 3 * rate}};
}

Joints jointsBy(double s) {
  Joints q = kReady;
  for (std::size_t i = 0; i < 7; i++) {
    q[i] += s * (i % 2 == 0 ? 0.2 : -0.15);
  }
  return q;
}

Joints speedsAt(double t) {
  Joints dq{};
  for (std::size_t i = 0; i < 7; i++) {
    dq[i] = 0.5 * kPi * std::sin(kPi * std::min(t, 1.0)) * (i % 2 == 0 ? 0.2 : -0.15);
  }
  return dq;
}

/// Command of each generator at time t of the same smooth motion.
RobotCommand commandAt(MotionGeneratorMode mode, double t) {
  switch (mode) {
    case MotionGeneratorMode::kJointPosition:
      return jointPositions(jointsBy(way(t)));
    case MotionGeneratorMode::kJointVelocity:
      return jointVelocities(speedsAt(t));
    case MotionGeneratorMode::kCartesianPosition:
      return pose(movedBy(way(t)));
    default:
      return twist(twistAt(t));
  }
}

template <std::size_t kSize>
void expectNear(const std::array<double, kSize>& a, const std::array<double, kSize>& b,
                double tolerance, const char* what) {
  for (std::size_t i = 0; i < kSize; i++) {
    EXPECT_NEAR(a[i], b[i], tolerance) << what << " " << i;
  }
}

class EachGenerator : public ::testing::TestWithParam<MotionGeneratorMode> {
 protected:
  bool cartesian() const {
    return GetParam() == MotionGeneratorMode::kCartesianPosition ||
           GetParam() == MotionGeneratorMode::kCartesianVelocity;
  }
};

TEST_P(EachGenerator, ShowsConsistentStatesAlongASmoothMotion) {
  for (unsigned protocol : kProtocols) {
    Motion motion(protocol, GetParam());
    DesiredMotion before = motion.desired();
    EXPECT_EQ(kReady, before.q_d);
    EXPECT_EQ(forward(kReady), before.O_T_EE_c);
    for (int tick = 0; tick <= 1000; tick++) {
      rt_guard::Scope scope;
      const MotionStep step = motion.step(commandAt(GetParam(), tick * kTick));
      ASSERT_EQ(0U, scope.allocations() + scope.locks()) << "in tick " << tick;
      ASSERT_FALSE(step.errors) << step.errors << " in tick " << tick;
      const DesiredMotion& now = motion.desired();
      expectNear(forward(now.q_d), now.O_T_EE_d, 1e-15, "pose of q_d");
      expectNear(now.O_T_EE_c, now.O_T_EE_d, 1e-12, "O_T_EE_c and O_T_EE_d");
      const auto jacobian = model().zeroJacobian(ArmFrame::kEndEffector, now.q_d, kHandF_T_NE);
      for (std::size_t i = 0; i < 6; i++) {
        double rate = 0.0;
        for (std::size_t k = 0; k < 7; k++) {
          rate += jacobian[6 * k + i] * now.dq_d[k];
        }
        EXPECT_NEAR(rate, now.O_dP_EE_d[i], 1e-14) << "J dq_d " << i;
        EXPECT_NEAR(now.O_dP_EE_c[i], now.O_dP_EE_d[i], 2e-3) << "twists " << i;
      }
      if (tick > 0) {
        for (std::size_t i = 0; i < 7; i++) {
          EXPECT_NEAR((now.q_d[i] - before.q_d[i]) / kTick, now.dq_d[i], 1e-11);
          EXPECT_NEAR((now.dq_d[i] - before.dq_d[i]) / kTick, now.ddq_d[i], 1e-9);
        }
        for (std::size_t i = 0; i < 6; i++) {
          EXPECT_NEAR((now.O_dP_EE_c[i] - before.O_dP_EE_c[i]) / kTick, now.O_ddP_EE_c[i], 1e-9);
        }
        EXPECT_NEAR((now.elbow_c[0] - before.elbow_c[0]) / kTick, now.delbow_c[0], 1e-9);
      }
      EXPECT_NEAR(now.elbow_c[0], now.elbow_d[0], 1e-12);
      EXPECT_EQ(-1.0, now.elbow_c[1]);
      before = now;
    }
    // End of the motion: integrated velocities may be off by one millisecond.
    if (cartesian()) {
      expectNear(movedBy(1.0), before.O_T_EE_c, 1e-5, "end");
      EXPECT_NEAR(kReady[2], before.q_d[2], 1e-12);
    } else {
      expectNear(jointsBy(1.0), before.q_d, 1e-5, "end");
    }
    EXPECT_TRUE(motion.step(finished(commandAt(GetParam(), 1.0))).finished);
  }
}

TEST_P(EachGenerator, KeepsTheAccelerationWhileCommandsAreLost) {
  for (int lost = 1; lost <= 19; lost++) {
    Motion motion(5, GetParam());
    for (int tick = 0; tick < 250; tick++) {
      ASSERT_FALSE(motion.step(commandAt(GetParam(), tick * kTick)).errors);
    }
    const DesiredMotion at = motion.desired();
    for (int i = 0; i < lost; i++) {
      const MotionStep step = motion.lose();
      ASSERT_FALSE(step.errors) << step.errors << " after " << i;
      EXPECT_FALSE(step.finished);
    }
    // Closed form of backward Euler with a constant acceleration.
    const double t = lost * kTick;
    const double square = 0.5 * lost * (lost + 1) * kTick * kTick;
    const DesiredMotion& now = motion.desired();
    if (cartesian()) {
      for (std::size_t i = 0; i < 3; i++) {
        EXPECT_NEAR(at.O_T_EE_c[12 + i] + at.O_dP_EE_c[i] * t + at.O_ddP_EE_c[i] * square,
                    now.O_T_EE_c[12 + i], 1e-12);
      }
      for (std::size_t i = 0; i < 6; i++) {
        EXPECT_NEAR(at.O_ddP_EE_c[i], now.O_ddP_EE_c[i], 1e-12);
        EXPECT_NEAR(at.O_dP_EE_c[i] + at.O_ddP_EE_c[i] * t, now.O_dP_EE_c[i], 1e-12);
      }
      expectNear(now.O_T_EE_c, now.O_T_EE_d, 1e-12, "O_T_EE_c and O_T_EE_d");
    } else {
      for (std::size_t i = 0; i < 7; i++) {
        EXPECT_NEAR(at.q_d[i] + at.dq_d[i] * t + at.ddq_d[i] * square, now.q_d[i], 1e-12);
        EXPECT_NEAR(at.dq_d[i] + at.ddq_d[i] * t, now.dq_d[i], 1e-12);
        EXPECT_EQ(at.ddq_d[i], now.ddq_d[i]);
      }
    }
    // A client that follows the clock finds the arm where it expects it.
    if (lost <= 10) {
      const MotionStep step = motion.step(commandAt(GetParam(), (250 + lost) * kTick));
      EXPECT_FALSE(lost <= 2 && step.errors) << "after " << lost;
    }
  }
}

TEST_P(EachGenerator, NothingMovesBeforeTheFirstCommand) {
  Motion motion(5, GetParam());
  for (int i = 0; i < 19; i++) {
    EXPECT_FALSE(motion.lose().errors);
  }
  EXPECT_EQ(kReady, motion.desired().q_d);
  EXPECT_FALSE(motion.step(commandAt(GetParam(), 0.0)).errors);
}

TEST_P(EachGenerator, RefusesAFinishAtSpeed) {
  const ErrorSet flags =
      cartesian() ? setOf({RobotError::kCartesianMotionGeneratorVelocityDiscontinuity,
                           RobotError::kCartesianMotionGeneratorAccelerationDiscontinuity})
                  : setOf({RobotError::kJointMotionGeneratorVelocityDiscontinuity,
                           RobotError::kJointMotionGeneratorAccelerationDiscontinuity});
  Motion motion(5, GetParam());
  for (int tick = 0; tick < 500; tick++) {
    const RobotCommand command = commandAt(GetParam(), tick * kTick);
    ASSERT_FALSE(motion.step(command).finished);
  }
  const MotionStep step = motion.step(finished(commandAt(GetParam(), 0.5)));
  EXPECT_TRUE(step.finished);
  EXPECT_EQ(flags, step.errors);
}

INSTANTIATE_TEST_SUITE_P(All, EachGenerator,
                         ::testing::Values(MotionGeneratorMode::kJointPosition,
                                           MotionGeneratorMode::kJointVelocity,
                                           MotionGeneratorMode::kCartesianPosition,
                                           MotionGeneratorMode::kCartesianVelocity));

}  // namespace

}  // namespace franka_sim::test
