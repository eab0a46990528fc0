// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Joint commands integrated from jerk: just inside each limit they pass, just outside they raise
// only the flag of their stage.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "motion_fixture.h"

namespace franka_sim::test {

using franka_core::RobotError;

namespace {

/// How a client sends commands and keeps its history.
struct JointClient {
  MotionGeneratorMode mode;
  bool reads_floats;  // takes its history from the received states instead of its own
};

/// Drives one joint by jerk, backward Euler, from q at rest; the others stand.
class JointDrive {
 public:
  JointDrive(unsigned protocol, JointClient client, std::size_t joint, const Joints& q)
      : client_(client), joint_(joint), motion_(protocol, client.mode, q), q_(q) {
    fault_ = motion_.step(command()).errors;
  }

  void tick(double jerk) {
    if (fault_) {
      return;
    }
    if (client_.reads_floats) {
      const DesiredMotion& seen = motion_.desired();
      q_[joint_] = asFloat(seen.q_d[joint_]);
      v_ = asFloat(seen.dq_d[joint_]);
      a_ = asFloat(seen.ddq_d[joint_]);
    }
    a_ += jerk * kTick;
    v_ += a_ * kTick;
    q_[joint_] += v_ * kTick;
    fault_ = motion_.step(command()).errors;
  }

  /// One tick towards an acceleration, limited by this jerk.
  void tickTowards(double acceleration, double jerk) {
    const double seen = client_.reads_floats ? asFloat(motion_.desired().ddq_d[joint_]) : a_;
    tick(std::min(std::max((acceleration - seen) / kTick, -jerk), jerk));
  }

  /// Brings the acceleration to a value with the given jerk.
  void accelerateTo(double acceleration, double jerk) {
    while (!fault_ && std::abs(acceleration - a_) > 1e-9) {
      tickTowards(acceleration, jerk);
    }
  }

  double velocity() const { return v_; }
  ErrorSet fault() const { return fault_; }
  const MotionLimits& limits() const { return motion_.limits(); }

 private:
  RobotCommand command() const {
    Joints dq{};
    dq[joint_] = v_;
    return client_.mode == MotionGeneratorMode::kJointPosition ? jointPositions(q_)
                                                               : jointVelocities(dq);
  }

  JointClient client_;
  std::size_t joint_;
  Motion motion_;
  Joints q_;
  double v_{0.0}, a_{0.0};
  ErrorSet fault_;
};

// Alternates at full jerk, so that a float's rounding cannot hide all of it.
void reachJerk(JointDrive& drive, double share, std::size_t joint) {
  const double jerk = share * drive.limits().arm.dddq[joint];
  for (int i = 0; i < 20; i++) {
    drive.tick(i % 2 == 0 ? jerk : -jerk);
  }
}

void reachAcceleration(JointDrive& drive, double share, std::size_t joint) {
  const double acceleration = share * drive.limits().arm.ddq[joint];
  const double jerk = 0.5 * drive.limits().arm.dddq[joint];
  drive.accelerateTo(acceleration, jerk);
  for (int i = 0; i < 20; i++) {
    drive.tickTowards(acceleration, jerk);
  }
}

void speedUpTo(JointDrive& drive, double velocity, double acceleration, double jerk) {
  while (!drive.fault() && drive.velocity() < velocity) {
    drive.tickTowards(acceleration, jerk);
  }
}

void reachVelocity(JointDrive& drive, double share, std::size_t joint) {
  const double target = share * drive.limits().arm.dq[joint];
  const double acceleration = 0.8 * drive.limits().arm.ddq[joint];
  const double jerk = 0.5 * drive.limits().arm.dddq[joint];
  // Ramping down from this acceleration takes a / j seconds and adds a^2 / 2j; then slowly up.
  const double rest = 0.5 * acceleration * acceleration / jerk + 2.0 * acceleration * kTick;
  speedUpTo(drive, target - rest, acceleration, jerk);
  drive.accelerateTo(0.0, jerk);
  speedUpTo(drive, target, 0.1 * acceleration, jerk);
}

struct Stage {
  RobotError flag;
  std::function<void(JointDrive&, double, std::size_t)> reach;
};

const std::vector<Stage> kStages{
    {RobotError::kJointMotionGeneratorAccelerationDiscontinuity, reachJerk},
    {RobotError::kJointMotionGeneratorVelocityDiscontinuity, reachAcceleration},
    {RobotError::kJointMotionGeneratorVelocityLimitsViolation, reachVelocity}};

/// A pose with enough range to reach the highest velocity upwards.
Joints lowPose(const MotionLimits& limits) {
  Joints q = limits.arm.q_min;
  for (double& value : q) {
    value += 0.3;
  }
  return q;
}

void passesInsideAndFailsOutside(JointClient client, unsigned protocol, double outside) {
  const Joints q = lowPose(motionLimitsOfProtocol(protocol));
  for (const Stage& stage : kStages) {
    for (std::size_t joint = 0; joint < 7; joint++) {
      SCOPED_TRACE(::testing::Message() << "protocol " << protocol << ", joint " << joint + 1
                                        << ", flag " << stage.flag);
      JointDrive inside(protocol, client, joint, q);
      stage.reach(inside, 0.99, joint);
      EXPECT_FALSE(inside.fault()) << inside.fault();
      JointDrive beyond(protocol, client, joint, q);
      stage.reach(beyond, outside, joint);
      ASSERT_TRUE(beyond.fault());
      EXPECT_EQ(stage.flag, beyond.fault());
    }
  }
}

TEST(JointLimits, PositionsPassInsideAndRaiseTheirFlagOutside) {
  for (unsigned protocol : kProtocols) {
    passesInsideAndFailsOutside({MotionGeneratorMode::kJointPosition, false}, protocol, 1.01);
  }
}

TEST(JointLimits, VelocitiesPassInsideAndRaiseTheirFlagOutside) {
  for (unsigned protocol : kProtocols) {
    passesInsideAndFailsOutside({MotionGeneratorMode::kJointVelocity, false}, protocol, 1.01);
  }
}

TEST(JointLimits, ClientsThatReadFloatsPassInsideAndFailOutside) {
  passesInsideAndFailsOutside({MotionGeneratorMode::kJointPosition, true}, 10, 1.01);
  passesInsideAndFailsOutside({MotionGeneratorMode::kJointVelocity, true}, 10, 1.01);
}

TEST(JointLimits, PositionsEndAtTheRangeWithTheFlagOfTheSystem) {
  for (const auto& [protocol, flag] :
       {std::pair{5U, RobotError::kJointMotionGeneratorPositionLimitsViolation},
        std::pair{8U, RobotError::kJointMotionGeneratorPositionLimitsViolation},
        std::pair{9U, RobotError::kJointPositionLimitsViolation},
        std::pair{10U, RobotError::kJointPositionLimitsViolation}}) {
    const MotionLimits limits = motionLimitsOfProtocol(protocol);
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

TEST(JointLimits, VelocitiesEndAtTheRangeToo) {
  Joints q = kReady;
  q[0] = kReady[0] + 2.895;
  Motion motion(5, MotionGeneratorMode::kJointVelocity, q);
  Joints dq{};
  ErrorSet fault;
  while (!fault) {
    dq[0] = std::min(dq[0] + 1e-3, 0.1);
    fault = motion.step(jointVelocities(dq)).errors;
  }
  EXPECT_EQ(RobotError::kJointMotionGeneratorPositionLimitsViolation, fault);
  EXPECT_NEAR(2.8973, motion.desired().q_d[0], 2e-4);
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
    const MotionLimits limits = motionLimitsOfProtocol(protocol);
    for (std::size_t joint = 0; joint < 7; joint++) {
      SCOPED_TRACE(::testing::Message() << "protocol " << protocol << ", joint " << joint + 1);
      // Closed form, 0.3 rad before the end (protocol 5.5).
      const auto& near = limits.velocity_near_ends;
      Joints q = kReady;
      q[joint] = near.q_max[joint] - 0.3;
      const double highest = std::sqrt(near.deceleration[joint] * 0.3) - near.offset[joint];
      EXPECT_NEAR(highest, limits.highestVelocity(joint, q[joint]), 1e-12);
      const double shrunk = 0.5 * near.deceleration[joint] * kTick;  // at most, in a tick
      Motion motion(protocol, MotionGeneratorMode::kJointVelocity, q);
      Joints dq{};
      ErrorSet fault;
      while (!fault && dq[joint] < 2.0) {
        dq[joint] += 4e-3;  // jerk-limited steps in turn: 4 rad/s^2
        fault = motion.step(jointVelocities(dq)).errors;
      }
      EXPECT_EQ(RobotError::kJointMotionGeneratorVelocityLimitsViolation, fault);
      EXPECT_GT(dq[joint], limits.highestVelocity(joint, motion.desired().q_d[joint]));
      EXPECT_LT(dq[joint],
                limits.highestVelocity(joint, motion.desired().q_d[joint]) + 4e-3 + shrunk);
    }
  }
}

TEST(JointLimits, NonFiniteCommandsAreRefused) {
  for (const double bad : {NAN, INFINITY, -INFINITY}) {
    Joints q = kReady;
    q[4] = bad;
    Motion positions(5, MotionGeneratorMode::kJointPosition);
    EXPECT_EQ(RobotError::kJointMotionGeneratorVelocityLimitsViolation,
              positions.step(jointPositions(q)).errors);
    EXPECT_FALSE(positions.step(jointPositions(kReady)).errors);
    EXPECT_EQ(RobotError::kJointMotionGeneratorVelocityLimitsViolation,
              positions.step(jointPositions(q)).errors);
    EXPECT_EQ(kReady, positions.desired().q_d);
    Motion velocities(5, MotionGeneratorMode::kJointVelocity);
    EXPECT_EQ(RobotError::kJointMotionGeneratorVelocityLimitsViolation,
              velocities.step(jointVelocities(q)).errors);
  }
}

}  // namespace

}  // namespace franka_sim::test
