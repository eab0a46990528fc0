// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Each error of the robot, raised through the whole control unit (decision 45): alone, or together
// with the others whose rules the same command violates (decision 47).
#include <random>

#include "fci_fixture.h"
#include "robot/safety/collisions.h"

namespace franka_sim::test {

namespace {

/// A pose close to a self-collision, and the direction into it.
struct NearlyOne {
  std::array<double, 7> q{};  ///< [rad]
  std::size_t joint{0};       ///< the joint that leads there on the shortest path
  double direction{0.0};      ///< -1 or 1
};

/// Found from a fixed seed, 5 to 10 mm apart.
NearlyOne nearlyOne(const franka_core::ArmModel& model) {
  std::mt19937 random(7);
  SelfCollision geometry(true);
  const franka_core::ArmLimits& limits = franka_core::kFerLimits;
  NearlyOne found;
  double distance = 0.0;
  for (int tries = 0; tries < 100000 && !(distance > 0.005 && distance < 0.01); tries++) {
    for (std::size_t i = 0; i < 7; i++) {
      found.q[i] =
          std::uniform_real_distribution<>(limits.q_min[i] + 0.3, limits.q_max[i] - 0.3)(random);
    }
    distance = geometry.closest(model, found.q).distance;
  }
  EXPECT_GT(distance, 0.005);
  EXPECT_LT(distance, 0.01);
  double steepest = 0.0;
  for (std::size_t i = 0; i < 7; i++) {
    std::array<double, 7> near = found.q;
    near[i] += 1e-4;
    const double slope = geometry.closest(model, near).distance - distance;
    if (std::abs(slope) > std::abs(steepest)) {
      steepest = slope;
      found.joint = i;
      found.direction = std::copysign(1.0, -slope);
    }
  }
  return found;
}

class ErrorFlags : public FciTest {
 protected:
  /// The motion ended with exactly this flag.
  void expectReflex(int flag) { expectReflex(std::vector<int>{flag}); }
  /// The motion ended with exactly these flags.
  void expectReflex(const std::vector<int>& flags) {
    EXPECT_EQ(flags, raised());
    EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode);
    EXPECT_EQ(MotionGeneratorMode::kIdle, unit.state().motion_generator_mode);
    for (const int flag : flags) {
      EXPECT_TRUE(unit.state().reflex_reason[static_cast<std::size_t>(flag)]);
    }
    const std::optional<Status> end = unit.takeAnswer(PendingAnswer::kMotion);
    if (moved) {
      ASSERT_TRUE(end);
      EXPECT_EQ(Status::kReflexAborted, *end);
    } else {
      EXPECT_FALSE(end);
    }
  }

  void move(MotionGeneratorMode generator, ControllerMode controller) {
    startMove(generator, controller);
    moved = true;
  }
  void moveJoints() { move(MotionGeneratorMode::kJointPosition, ControllerMode::kJointImpedance); }
  void turnJoints() { move(MotionGeneratorMode::kJointVelocity, ControllerMode::kJointImpedance); }
  void movePose() {
    move(MotionGeneratorMode::kCartesianPosition, ControllerMode::kJointImpedance);
  }
  void moveTwist() {
    move(MotionGeneratorMode::kCartesianVelocity, ControllerMode::kJointImpedance);
  }
  void applyTorque() { move(MotionGeneratorMode::kNone, ControllerMode::kExternalController); }

  /// Joint velocities or twists that grow at this rate from 0.
  void ramp(std::size_t axis, double rate, int ticks = 2000) {
    drive(ticks, [&](int i, const RobotState&) {
      RobotCommand command;
      command.dq_c[axis] = rate * 1e-3 * (i + 1);
      if (axis < 6) {
        command.O_dP_EE_c[axis] = rate * 1e-3 * (i + 1);
      }
      return command;
    });
  }

  RobotCommand still() const {
    RobotCommand command;
    command.q_c = unit.state().q_d;
    command.O_T_EE_c = unit.state().O_T_EE_c;
    command.elbow_c = unit.state().elbow_c;
    return command;
  }

  bool moved{false};
};

TEST_F(ErrorFlags, JointPositionLimits) {
  for (const double sign : {1.0, -1.0}) {
    standAt(kReady);
    tickWith([&](ArmMeasurement& m) { m.q[0] = sign * 2.902; });
    EXPECT_TRUE(raised().empty());
    tickWith([&](ArmMeasurement& m) { m.q[0] = sign * 2.903; });
    expectReflex(0);
  }
}

TEST_F(ErrorFlags, VirtualWall) {
  franka_core::fci::CartesianLimit wall;
  wall.object_world_size = {{2, 1, 2}};
  wall.object_frame = franka_core::kIdentityTransform;
  wall.object_frame[13] = 0.6;  // from y = 0.1 on
  wall.active = true;
  ASSERT_EQ(Status::kSuccess, unit.request(SetVirtualWall{3, wall}));
  moveTwist();
  ramp(1, 0.3);
  expectReflex(1);
  EXPECT_NEAR(0.1, unit.state().O_T_EE[13], 0.01);
}

TEST_F(ErrorFlags, MotionOutOfAVirtualWallIsAllowed) {
  for (const double direction : {1.0, -1.0}) {
    standAt(kReady);
    franka_core::fci::CartesianLimit wall;
    wall.object_world_size = {{2, 1, 2}};
    wall.object_frame = franka_core::kIdentityTransform;
    wall.object_frame[13] = 0.48;  // from y = -0.02 on: the hand is two centimeters inside
    wall.active = true;
    ASSERT_EQ(Status::kSuccess, unit.request(SetVirtualWall{0, wall}));
    moveTwist();
    ramp(1, 0.1 * direction, 800);
    if (direction > 0.0) {
      expectReflex(1);
      EXPECT_NEAR(0.0, unit.state().O_T_EE[13], 1e-3);
    } else {
      EXPECT_TRUE(raised().empty());
      EXPECT_LT(unit.state().O_T_EE[13], -0.03);
    }
  }
}

TEST_F(ErrorFlags, SelfCollision) {
  const NearlyOne near = nearlyOne(parameters.model);
  standAt(near.q);
  turnJoints();
  ramp(near.joint, 0.5 * near.direction);
  expectReflex(2);
  EXPECT_LT(unit.status().self_collision.distance, 0.0);
  EXPECT_GE(unit.status().self_collision.second - unit.status().self_collision.first, 2);
}

TEST_F(ErrorFlags, SelfCollisionUnderTorquesIgnoresTheGenerator) {
  // Torque control of protocols 3 to 9 comes with joint velocities of zero: the desired joint
  // positions stay where the motion began, while the torques move the arm.
  const NearlyOne near = nearlyOne(parameters.model);
  for (const MotionGeneratorMode generator :
       {MotionGeneratorMode::kNone, MotionGeneratorMode::kJointVelocity,
        MotionGeneratorMode::kJointPosition, MotionGeneratorMode::kCartesianVelocity}) {
    standAt(near.q);
    ignoreCollisions();
    move(generator, ControllerMode::kExternalController);
    drive(2000, [&](int i, const RobotState&) {
      RobotCommand command = still();
      command.tau_J_d[near.joint] = near.direction * std::min(0.1 * i, 2.0);
      return command;
    });
    SCOPED_TRACE(static_cast<int>(generator));
    expectReflex(2);
    EXPECT_LT(unit.status().self_collision.distance, 0.0);
    EXPECT_GT(unit.status().self_collision.distance, -1e-3) << "detected late";
  }
}

TEST_F(ErrorFlags, MeasuredJointVelocity) {
  ignoreCollisions();
  tickWith([](ArmMeasurement& m) { m.dq[6] = 2.7; });
  EXPECT_TRUE(raised().empty());
  tickWith([](ArmMeasurement& m) { m.dq[6] = 2.75; });
  expectReflex(3);
}

TEST_F(ErrorFlags, MeasuredCartesianVelocity) {
  ignoreCollisions();
  const std::array<double, 7> stretched{{0, 0.9, 0, -0.5, 0, 1.5, 0}};
  standAt(stretched);
  ignoreCollisions();
  tickWith([](ArmMeasurement& m) {
    m.dq = {{2.1, 2.1, 0, -2.1, 0, 0, 0}};
    m.tau_J.fill(0.0);
  });
  expectReflex(4);
}

TEST_F(ErrorFlags, ForceControlSafety) {
  ignoreCollisions();
  applyTorque();
  const RobotCommand zero;
  run(5, &zero);
  tickWith([](ArmMeasurement& m) { m.tau_J[0] += 86; }, &zero);
  EXPECT_TRUE(raised().empty());
  tickWith([](ArmMeasurement& m) { m.tau_J[0] += 90; }, &zero);
  expectReflex(5);
}

TEST_F(ErrorFlags, JointReflex) {
  CollisionThresholds thresholds = parameters.nominal;
  thresholds.upper_force.fill(1e6);
  unit.request(collisionRequest(thresholds, thresholds));
  moveJoints();
  arm.push = {{0, 60, 0, 0, 0, 0}};
  drive(200, [&](int, const RobotState&) { return still(); });
  expectReflex(6);
  EXPECT_NE((std::array<double, 7>{}), unit.state().joint_collision);
}

TEST_F(ErrorFlags, CartesianReflex) {
  CollisionThresholds thresholds = parameters.nominal;
  thresholds.upper_torque.fill(1e6);
  unit.request(collisionRequest(thresholds, thresholds));
  moveJoints();
  arm.push = {{0, 60, 0, 0, 0, 0}};
  drive(200, [&](int, const RobotState&) { return still(); });
  expectReflex(7);
  EXPECT_EQ(1.0, unit.state().cartesian_collision[1]);
}

TEST_F(ErrorFlags, GoalAndPathDeviation) {
  for (const int flag : {8, 9}) {
    arm.push.fill(0.0);
    standAt(kReady);
    ignoreCollisions();
    auto move = moveRequest(MotionGeneratorMode::kJointPosition);
    (flag == 8 ? move.max_goal_deviation : move.max_path_deviation).translation = 1e-3;
    ASSERT_EQ(Status::kMotionStarted, unit.request(move));
    moved = true;
    arm.push = {{0, 40, 0, 0, 0, 0}};
    drive(500, [&](int i, const RobotState&) {
      RobotCommand command = still();
      command.motion_generation_finished = i == 400;
      return command;
    });
    expectReflex(flag);
  }
}

TEST_F(ErrorFlags, VelocityProfile) {
  standAt({{0, 0.3, 0, -1.5, 0, 1.8, 0.785}});
  ignoreCollisions();
  moveTwist();
  ramp(1, 2.0, 250);
  ASSERT_EQ(std::vector<int>{}, raised());
  const RobotCommand command = [&] {
    RobotCommand same;
    same.O_dP_EE_c = unit.state().O_dP_EE_c;
    return same;
  }();
  tickWith(
      [](ArmMeasurement& m) {
        m.dq[0] = -2.0;
        m.dq[2] = -0.9;
        m.tau_J.fill(0.0);
      },
      &command);
  expectReflex(10);
}

TEST_F(ErrorFlags, FirstCommandOfAMotion) {
  struct Row {
    int flag;
    MotionGeneratorMode generator;
    std::function<void(RobotCommand&)> change;
  };
  constexpr auto kPose = MotionGeneratorMode::kCartesianPosition;
  const Row rows[] = {
      {11, MotionGeneratorMode::kJointPosition, [](RobotCommand& c) { c.q_c[2] += 0.01; }},
      {16, kPose, [](RobotCommand& c) { c.O_T_EE_c[12] += 0.005; }},
      {21, kPose, [](RobotCommand& c) { c.valid_elbow = true, c.elbow_c[1] = 1.0; }},
      {22, kPose, [](RobotCommand& c) { c.valid_elbow = true, c.elbow_c[0] = 0.1; }},
      {31, kPose, [](RobotCommand& c) { c.O_T_EE_c[0] *= 1.01; }}};
  for (const Row& row : rows) {
    standAt(kReady);
    move(row.generator, ControllerMode::kJointImpedance);
    drive(1, [&](int, const RobotState&) {
      RobotCommand command = still();
      row.change(command);
      return command;
    });
    expectReflex(row.flag);
  }
  // A load bends the arm away from q_d, with which the command is compared.
  standAt(kReady);
  ignoreCollisions();
  arm.push = {{0, 0, -20, 0, 0, 0}};
  run(1000);
  ASSERT_GT(largestDifference(unit.state().q, unit.state().q_d), 2e-3);
  moveJoints();
  drive(3, [&](int, const RobotState&) { return still(); });
  EXPECT_TRUE(raised().empty());
}

TEST_F(ErrorFlags, JointsReachTheirLimits) {
  struct Row {
    MotionGeneratorMode generator;
    std::array<double, 7> start;
    std::size_t axis;
    double rate;  // [rad/s^2] or [m/s^2]
    std::vector<int> flags;
  };
  constexpr auto kTwist = MotionGeneratorMode::kCartesianVelocity;
  const Row rows[] = {
      {MotionGeneratorMode::kJointVelocity,
       {{2.88, -0.785, 0, -2.356, 0, 1.571, 0.785}},
       0,
       0.3,
       {12}},
      // Inverse kinematics reaches the end of joint 7.
      {kTwist, {{0, -0.785, 0, -2.356, 0, 1.571, 2.88}}, 5, -0.3, {27}},
      // Sideways, 0.31 m from the first axis: a slow motion of the hand is fast for the joint.
      {kTwist, kReady, 1, 1.5, {28}},
      {kTwist, kReady, 1, 6.0, {29, 30}}};
  for (const Row& row : rows) {
    standAt(row.start);
    move(row.generator, ControllerMode::kJointImpedance);
    ramp(row.axis, row.rate);
    expectReflex(row.flags);
    EXPECT_LT(unit.state().q[0], 2.8983) << "braked before the limit of the measured joint";
  }
}

TEST_F(ErrorFlags, JumpOfJointPositionsRaisesAllItsFlags) {
  // Seen on real robots: a jump raises 13, 14 and 15 together, a smaller one 14 and 15.
  // One whose derivatives overflow is beyond the range as well.
  for (const auto& [jump, flags] :
       {std::pair{0.01, std::vector<int>{13, 14, 15}}, std::pair{1e-4, std::vector<int>{14, 15}},
        std::pair{1e300, std::vector<int>{12, 13, 14, 15}}}) {
    standAt(kReady);
    moveJoints();
    drive(3, [&, jump = jump](int i, const RobotState&) {
      RobotCommand command = still();
      command.q_c[2] += i == 2 ? jump : 0.0;
      return command;
    });
    expectReflex(flags);
  }
}

TEST_F(ErrorFlags, JumpOfThePoseRaisesAllItsFlags) {
  // Seen on real robots: 18, 19 and 20 together with 30, the jerk of a joint; a smaller jump raises
  // 19, 20 and 30. Of the joints only the jerk counts then.
  struct Row {
    double jump, elbow;
    std::vector<int> flags;
  };
  for (const Row& row : {Row{0.01, 0.0, {18, 19, 20, 30}}, Row{1e-4, 0.0, {19, 20, 30}},
                         Row{0.01, 0.01, {17, 18, 19, 20, 30}}}) {
    standAt(kReady);
    movePose();
    drive(3, [&](int i, const RobotState&) {
      RobotCommand command = still();
      command.valid_elbow = row.elbow != 0.0;
      command.elbow_c[0] += i == 2 ? row.elbow : 0.0;
      command.O_T_EE_c[14] += i == 2 ? row.jump : 0.0;
      return command;
    });
    expectReflex(row.flags);
  }
}

TEST_F(ErrorFlags, CartesianRampAtItsLimitsRaisesBothFlagsOfTheJoints) {
  // Seen on real FERs: 13 m/s^2 at 6500 m/s^3, which the hand may do, and joint 1 may not.
  moveTwist();
  double velocity = 0.0;
  drive(10, [&](int i, const RobotState&) {
    velocity += std::min(6.49 * (i + 1), 12.99) * 1e-3;
    RobotCommand command;
    command.O_dP_EE_c[1] = velocity;
    return command;
  });
  expectReflex({29, 30});
}

TEST_F(ErrorFlags, MeasuredLimitsRaiseTheirFlagsTogether) {
  ignoreCollisions();
  tickWith([](ArmMeasurement& m) {
    m.q[0] = 2.91;
    m.dq[0] = 2.4;
    m.tau_J[0] = 150.0;
  });
  expectReflex({0, 3, 26, 34});
}

TEST_F(ErrorFlags, ForceTolerance) {
  ignoreCollisions();
  applyTorque();
  const RobotCommand zero;
  run(5, &zero);
  for (int i = 0; i < 99; i++) {
    tickWith([](ArmMeasurement& m) { m.tau_J[1] -= 15; }, &zero);
    ASSERT_TRUE(raised().empty()) << i;
  }
  tickWith([](ArmMeasurement& m) { m.tau_J[1] -= 15; }, &zero);
  expectReflex(23);
}

TEST_F(ErrorFlags, TwentyLostCommandsButNotNineteen) {
  for (const ControllerMode controller :
       {ControllerMode::kJointImpedance, ControllerMode::kExternalController}) {
    standAt(kReady);
    move(MotionGeneratorMode::kJointPosition, controller);
    drive(50, [&](int, const RobotState&) { return still(); });
    run(19);
    EXPECT_TRUE(raised().empty());
    drive(1, [&](int, const RobotState&) { return still(); });
    run(19);
    EXPECT_TRUE(raised().empty());
    EXPECT_NEAR(0.62, unit.state().control_command_success_rate, 0.06);
    run(1);
    expectReflex(25);
    EXPECT_EQ(0.0, unit.state().control_command_success_rate);
  }
}

TEST_F(ErrorFlags, WaitsAThousandTicksForTheFirstCommand) {
  moveJoints();
  run(999);
  EXPECT_TRUE(raised().empty());
  run(1);
  expectReflex(25);
}

TEST_F(ErrorFlags, Power) {
  ignoreCollisions();
  tickWith([](ArmMeasurement& m) {
    m.dq = {{2, 0, 0, 2, 0, 0, 0}};
    m.tau_J = {{95, 0, 0, 70, 0, 0, 0}};
  });
  EXPECT_TRUE(raised().empty());
  tickWith([](ArmMeasurement& m) {
    m.dq = {{2, 0, 0, 2, 0, 0, 0}};
    m.tau_J = {{95, 0, 0, -90, 0, 0, 0}};  // one drives, one brakes
  });
  expectReflex(26);
}

TEST(ErrorFlagArithmetic, AtTenTimesTheJerkTheFlagNeverComesAlone) {
  // Why the unit limits flag 30 at 3.5 times the joints' jerk (docs/fidelity.md) and not at ten: so
  // large an acceleration step also exceeds the limit of acceleration on one of its sides.
  for (const auto* limits : {&franka_core::kFerLimits, &franka_core::kFr3Limits}) {
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_LT(2 * limits->ddq[i], 10 * limits->dddq[i] * 1e-3);
    }
  }
}

TEST_F(ErrorFlags, TorqueDiscontinuity) {
  applyTorque();
  RobotCommand command;
  for (const double tau : {1.0, 2.0, 1.0}) {
    command.tau_J_d[0] = tau;
    run(1, &command);
    EXPECT_TRUE(raised().empty());
  }
  command.tau_J_d[0] = 2.01;
  run(1, &command);
  expectReflex(32);
}

TEST_F(ErrorFlags, TorqueRange) {
  ignoreCollisions();
  tickWith([](ArmMeasurement& m) { m.tau_J[0] = 104; });
  EXPECT_TRUE(raised().empty());
  tickWith([](ArmMeasurement& m) { m.tau_J[0] = 105; });
  expectReflex(34);
}

TEST_F(ErrorFlags, NonFiniteCommandsEndTheMotion) {
  for (const auto& [generator, flag] : {std::pair{MotionGeneratorMode::kJointPosition, 13},
                                        std::pair{MotionGeneratorMode::kJointVelocity, 13},
                                        std::pair{MotionGeneratorMode::kCartesianPosition, 31},
                                        std::pair{MotionGeneratorMode::kCartesianVelocity, 18},
                                        std::pair{MotionGeneratorMode::kNone, 32}}) {
    for (const double bad : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
      for (const int before : {0, 3}) {
        standAt(kReady);
        move(generator, generator == MotionGeneratorMode::kNone
                            ? ControllerMode::kExternalController
                            : ControllerMode::kJointImpedance);
        drive(before, [&](int, const RobotState&) { return still(); });
        drive(1, [&, bad = bad](int, const RobotState&) {
          RobotCommand command = still();
          command.q_c[3] = command.dq_c[3] = command.O_T_EE_c[12] = bad;
          command.O_dP_EE_c[2] = command.tau_J_d[3] = bad;
          return command;
        });
        SCOPED_TRACE(::testing::Message() << bad << " after " << before);
        expectReflex(flag);
        run(300);
        expectNear(kReady, arm.q(), 1e-3);
      }
    }
  }
}

}  // namespace

}  // namespace franka_sim::test
