// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Starts, elbows, frames, resuming after losses, braking and the asynchronous generator.
#include <franka_sim/robot/motion/motion_generator.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "motion_fixture.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

Transform startPose() {
  return model().pose(franka_core::ArmFrame::kEndEffector, kReady, kHandF_T_NE);
}

Transform shifted(double x) {
  Transform pose = startPose();
  pose[12] += x;
  return pose;
}

TEST(MotionStart, RefusesInvalidStarts) {
  MotionGenerator generator;
  MotionStart start;
  start.q_d = kReady;
  for (const auto mode : {MotionGeneratorMode::kIdle, MotionGeneratorMode::kNone}) {
    start.mode = mode;
    EXPECT_EQ(MotionStartResult::kInvalidArgument, generator.start(start, model()));
  }
  start.mode = MotionGeneratorMode::kJointVelocity;
  start.asynchronous = true;
  start.maximum_velocity.fill(1.0);
  EXPECT_EQ(MotionStartResult::kInvalidArgument, generator.start(start, model()));
  start.mode = MotionGeneratorMode::kJointPosition;
  EXPECT_EQ(MotionStartResult::kStarted, generator.start(start, model()));
  for (const double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    start.maximum_velocity[3] = bad;
    EXPECT_EQ(MotionStartResult::kInvalidArgument, generator.start(start, model()));
  }
  start.asynchronous = false;
  start.q_d[1] = NAN;
  EXPECT_EQ(MotionStartResult::kInvalidArgument, generator.start(start, model()));
}

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

TEST(MotionStart, RoundingToFloatsIsWithinTheTolerances) {
  Motion joints(10, MotionGeneratorMode::kJointPosition);
  Joints q = kReady;
  std::transform(q.begin(), q.end(), q.begin(), asFloat);
  EXPECT_FALSE(joints.step(jointPositions(q)).errors);
  Motion cartesian(10, MotionGeneratorMode::kCartesianPosition);
  Transform start = startPose();
  std::transform(start.begin(), start.end(), start.begin(), asFloat);
  for (int i = 0; i < 100; i++) {
    EXPECT_FALSE(cartesian.step(pose(start)).errors);
  }
}

TEST(Frames, NonRigidTransformsAreRefused) {
  const Transform good = startPose();
  for (std::size_t i = 0; i < 16; i++) {
    for (const double bad : {good[i] + 0.1, static_cast<double>(NAN)}) {
      Motion motion(5, MotionGeneratorMode::kCartesianPosition);
      Transform broken = good;
      broken[i] = bad;
      const bool position = i >= 12 && i < 15 && std::isfinite(bad);
      EXPECT_EQ(position ? RobotError::kCartesianPositionMotionGeneratorStartPoseInvalid
                         : RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag,
                motion.step(pose(broken)).errors)
          << i;
    }
  }
  Motion motion(5, MotionGeneratorMode::kCartesianVelocity);
  EXPECT_EQ(RobotError::kCartesianMotionGeneratorVelocityLimitsViolation,
            motion.step(twist({{0, 0, 0, NAN, 0, 0}})).errors);
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

TEST(SolvedJoints, RaiseTheirOwnFlags) {
  // Slow enough for the hand, too fast for the joints: near its reach the elbow must open quickly.
  const auto flagOf = [](unsigned protocol, const Joints& q, const Twist& way,
                         double acceleration) {
    Motion motion(protocol, MotionGeneratorMode::kCartesianVelocity, q);
    double v = 0.0;
    double a = 0.0;
    ErrorSet fault;
    for (int tick = 0; tick < 4000 && !fault; tick++) {
      a = std::min(a + 0.5, acceleration);
      v += a * kTick;
      Twist command = way;
      for (double& value : command) {
        value *= v;
      }
      fault = motion.step(twist(command)).errors;
    }
    return fault;
  };
  EXPECT_EQ(RobotError::kCartesianMotionGeneratorJointVelocityLimitsViolation,
            flagOf(5, kReady, {{0, 1, 0, 0, 0, 0}}, 1.0));
  EXPECT_EQ(RobotError::kCartesianMotionGeneratorJointVelocityDiscontinuity,
            flagOf(5, kReady, {{1, 0, 0, 0, 0, 0}}, 3.0));
  Joints close_to_end = kReady;
  close_to_end[6] = 2.85;
  const Twist turn{{0, 0, 0, 0, 0, -1}};
  EXPECT_EQ(RobotError::kCartesianMotionGeneratorJointPositionLimitsViolation,
            flagOf(5, close_to_end, turn, 0.1));
}

TEST(SolvedJoints, HaveThreeAndAHalfTimesTheJerkLimit) {
  for (const auto& [acceleration, fault] :
       {std::pair{12.5, ErrorSet()},
        std::pair{14.0,
                  ErrorSet(RobotError::kCartesianMotionGeneratorJointAccelerationDiscontinuity)}}) {
    // From -a to +a in one tick: 25 000 and 28 000 rad/s^3, of 3.5 * 7500.
    const MotionLimits limits = motionLimitsOfProtocol(5);
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

/// An asynchronous motion and a check of its limits.
struct Async {
  explicit Async(unsigned protocol, double maximum_velocity = 1.0)
      : generator(motionLimitsOfProtocol(protocol)) {
    MotionStart start;
    start.q_d = kReady;
    start.asynchronous = true;
    start.maximum_velocity.fill(maximum_velocity);
    EXPECT_EQ(MotionStartResult::kStarted, generator.start(start, model()));
  }

  MotionStep step(const RobotCommand* command) {
    const DesiredMotion before = generator.desired();
    const MotionStep result = generator.step(command, model());
    const DesiredMotion& now = generator.desired();
    for (std::size_t i = 0; i < 7; i++) {
      const auto& arm = generator.limits().arm;
      EXPECT_LE(now.dq_d[i], generator.limits().highestVelocity(i, before.q_d[i]) + 1e-9);
      EXPECT_GE(now.dq_d[i], generator.limits().lowestVelocity(i, before.q_d[i]) - 1e-9);
      EXPECT_LE(std::abs(now.ddq_d[i]), arm.ddq[i]);
      EXPECT_LE(std::abs(now.ddq_d[i] - before.ddq_d[i]) / kTick, arm.dddq[i]);
      EXPECT_NEAR((now.q_d[i] - before.q_d[i]) / kTick, now.dq_d[i], 1e-12);
    }
    return result;
  }

  MotionGenerator generator;
};

TEST(AsyncJointGenerator, ReachesATargetExactlyInTrapezoidTime) {
  for (unsigned protocol : kProtocols) {
    Async motion(protocol);
    const auto& arm = motion.generator.limits().arm;
    Joints target = kReady;
    target[0] += 0.8;
    target[1] -= 0.01;
    const RobotCommand command = jointPositions(target);
    motion.step(&command);
    int ticks = 1;
    while (motion.generator.desired().q_d != target) {
      ASSERT_LT(ticks++, 5000);
      EXPECT_FALSE(motion.step(nullptr).finished);
    }
    const double expected = 0.8 / 1.0 + 1.0 / arm.ddq[0];  // way / v + v / a
    EXPECT_NEAR(expected / kTick, ticks, 8);
    const RobotCommand last = finished(command);
    MotionStep step = motion.step(&last);
    for (int i = 0; i < 5 && !step.finished; i++) {
      step = motion.step(&last);
    }
    EXPECT_TRUE(step.finished);
    EXPECT_FALSE(step.errors);
    EXPECT_EQ(target, motion.generator.desired().q_d);
    EXPECT_EQ(Joints{}, motion.generator.desired().dq_d);
  }
}

TEST(AsyncJointGenerator, TakesNewTargetsAtAnyTime) {
  for (unsigned protocol : kProtocols) {
    std::mt19937 engine(protocol);
    Async motion(protocol, 6.0);
    const auto& arm = motion.generator.limits().arm;
    for (int change = 0; change < 60; change++) {
      Joints target{};
      for (std::size_t i = 0; i < 7; i++) {
        const double span = arm.q_max[i] - arm.q_min[i];
        target[i] =
            arm.q_min[i] + span * std::uniform_real_distribution<double>(0.15, 0.85)(engine);
      }
      const RobotCommand command = jointPositions(target);
      const int ticks = std::uniform_int_distribution<int>(1, 500)(engine);
      for (int i = 0; i < ticks; i++) {
        ASSERT_FALSE(motion.step(i == 0 ? &command : nullptr).errors);
      }
      if (change == 59) {
        for (int i = 0; i < 8000; i++) {
          motion.step(nullptr);
        }
        EXPECT_EQ(target, motion.generator.desired().q_d);
      }
      if (::testing::Test::HasFailure()) {
        FAIL() << "protocol " << protocol << ", change " << change;
      }
    }
  }
}

/// The last reachable position of an FR3's joint in one direction, and one beyond it within its
/// limits.
struct End {
  std::size_t joint;
  double last, dead;
};

std::vector<End> endsOf(const MotionLimits& limits) {
  std::vector<End> ends;
  for (std::size_t i = 0; i < 7; i++) {
    const franka_core::JointRange reach = limits.reach(i);
    ends.push_back({i, reach.highest, 0.5 * (reach.highest + limits.arm.q_max[i])});
    ends.push_back({i, reach.lowest, 0.5 * (reach.lowest + limits.arm.q_min[i])});
  }
  return ends;
}

TEST(AsyncJointGenerator, ReachesTheLastTargetItAcceptsAndRefusesTheNext) {
  for (const End& end : endsOf(motionLimitsOfProtocol(10))) {
    Async motion(10, 2.0);
    Joints target = kReady;
    target[end.joint] = end.dead;
    RobotCommand command = jointPositions(target);
    EXPECT_EQ(RobotError::kJointPositionLimitsViolation, motion.step(&command).errors) << end.joint;
    Async allowed(10, 2.0);
    target[end.joint] = end.last;
    command = jointPositions(target);
    ASSERT_FALSE(allowed.step(&command).errors) << end.joint;
    int ticks = 0;
    while (allowed.generator.desired().q_d != target) {
      ASSERT_LT(ticks++, 10000) << end.joint;
      allowed.generator.step(nullptr, model());
    }
    const RobotCommand last = finished(command);
    bool over = false;
    for (int i = 0; i < 10 && !over; i++) {
      over = allowed.step(&last).finished;
    }
    EXPECT_TRUE(over) << end.joint;
  }
}

TEST(AsyncJointGenerator, AnArmBeyondItsReachMayStayOrReturn) {
  for (const End& end : endsOf(motionLimitsOfProtocol(10))) {
    MotionGenerator generator(motionLimitsOfProtocol(10));
    MotionStart start;
    start.q_d = kReady;
    start.q_d[end.joint] = end.dead;
    start.asynchronous = true;
    start.maximum_velocity.fill(1.0);
    ASSERT_EQ(MotionStartResult::kStarted, generator.start(start, model()));
    // As the client reads it from a state of protocol 10.
    Joints target = start.q_d;
    target[end.joint] = static_cast<double>(static_cast<float>(end.dead));
    RobotCommand command = jointPositions(target);
    EXPECT_FALSE(generator.step(&command, model()).errors) << end.joint;
    target[end.joint] = kReady[end.joint];
    command = jointPositions(target);
    ASSERT_FALSE(generator.step(&command, model()).errors) << end.joint;
    for (int i = 0; i < 8000 && generator.desired().q_d != target; i++) {
      generator.step(nullptr, model());
    }
    EXPECT_EQ(target, generator.desired().q_d) << end.joint;
  }
}

TEST(AsyncJointGenerator, FinishBrakesAndEndsForAnyTarget) {
  for (const double maximum_velocity : {1e-9, 1.5}) {
    Async motion(10, maximum_velocity);
    Joints target = kReady;
    target[0] = -2.0;
    target[3] = -1.0;
    const RobotCommand command = jointPositions(target);
    for (int i = 0; i < 400; i++) {
      motion.step(i == 0 ? &command : nullptr);
    }
    const RobotCommand last = finished(RobotCommand());
    MotionStep step;
    int ticks = 0;
    while (!step.finished) {
      ASSERT_LT(ticks++, 200);
      step = motion.step(ticks % 2 == 1 ? &last : nullptr);
      ASSERT_FALSE(step.errors);
    }
    EXPECT_EQ(Joints{}, motion.generator.desired().dq_d);
  }
}

TEST(AsyncJointGenerator, RefusesTargetsOutOfReach) {
  for (const auto& [protocol, flag] :
       {std::pair{8U, RobotError::kJointMotionGeneratorPositionLimitsViolation},
        std::pair{10U, RobotError::kJointPositionLimitsViolation}}) {
    Async motion(protocol);
    Joints target = kReady;
    target[3] = 0.0;
    RobotCommand command = jointPositions(target);
    EXPECT_EQ(flag, motion.step(&command).errors);
    target[3] = NAN;
    command = jointPositions(target);
    EXPECT_EQ(RobotError::kJointMotionGeneratorVelocityLimitsViolation,
              motion.step(&command).errors);
  }
}

}  // namespace

}  // namespace franka_sim::test
