// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Each error of the robot, raised through the whole control unit (decision 45): alone, or together
// with the others whose rules the same command violates (decision 47).
#include "fci_fixture.h"
#include "robot/safety/self_collision.h"

namespace franka_sim::test {

namespace {

class ErrorFlags : public FciTest {
 protected:
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
  void moveTwist() {
    move(MotionGeneratorMode::kCartesianVelocity, ControllerMode::kJointImpedance);
  }
  void applyTorque() { move(MotionGeneratorMode::kNone, ControllerMode::kExternalController); }

  /// Twists that grow at this rate from 0.
  void ramp(std::size_t axis, double rate, int ticks) {
    drive(ticks, [&](int i, const RobotState&) {
      RobotCommand command;
      command.O_dP_EE_c[axis] = rate * 1e-3 * (i + 1);
      return command;
    });
  }

  bool moved{false};
};

/// Measured values just within limits, and beyond them.
struct MeasuredRow {
  const char* name;
  std::vector<int> flags;
  std::function<void(ArmMeasurement&)> within, beyond;
  bool torque_control{false};
};

class MeasuredLimit : public ErrorFlags, public ::testing::WithParamInterface<MeasuredRow> {};

TEST_P(MeasuredLimit, RaisesItsFlagsBeyond) {
  standAt({{0, 0.9, 0, -0.5, 0, 1.5, 0}});  // stretched, so that the hand is fast
  ignoreCollisions();
  const RobotCommand zero;
  if (GetParam().torque_control) {
    applyTorque();
    run(5, &zero);
  }
  tickWith(GetParam().within, &zero);
  EXPECT_EQ(std::vector<int>{}, raised());
  tickWith(GetParam().beyond, &zero);
  expectReflex(GetParam().flags);
}

const MeasuredRow kMeasuredRows[] = {
    {"UpperPosition", {0}, [](auto& m) { m.q[0] = 2.902; }, [](auto& m) { m.q[0] = 2.903; }},
    {"LowerPosition", {0}, [](auto& m) { m.q[0] = -2.902; }, [](auto& m) { m.q[0] = -2.903; }},
    {"JointVelocity", {3}, [](auto& m) { m.dq[6] = 2.7; }, [](auto& m) { m.dq[6] = 2.75; }},
    {"CartesianVelocity",
     {4},
     [](auto& m) { m.tau_J.fill(0.0), m.dq = {{1.2, 1.2, 0, -1.2}}; },
     [](auto& m) { m.tau_J.fill(0.0), m.dq = {{1.5, 1.5, 0, -1.5}}; }},
    {"ForceControl",
     {5},
     [](auto& m) { m.tau_J[0] += 86; },
     [](auto& m) { m.tau_J[0] += 90; },
     true},
    {"Power",
     {26},
     [](auto& m) { m.dq[0] = m.dq[3] = 2, m.tau_J = {{95, 0, 0, 70}}; },
     // one drives, one brakes
     [](auto& m) { m.dq[0] = m.dq[3] = 2, m.tau_J = {{95, 0, 0, -90}}; }},
    {"Torque", {34}, [](auto& m) { m.tau_J[0] = 104; }, [](auto& m) { m.tau_J[0] = 105; }},
    {"All",
     {0, 3, 26, 34},
     [](auto& /*m*/) {},
     [](auto& m) { m.q[0] = 2.91, m.dq[0] = -2.4, m.tau_J[0] = 150.0; }}};
INSTANTIATE_TEST_SUITE_P(Rows, MeasuredLimit, ::testing::ValuesIn(kMeasuredRows),
                         [](const auto& row) { return row.param.name; });

/// A command that violates rules after valid ones, or commands that grow until they do.
struct CommandRow {
  const char* name;
  std::vector<int> flags;
  MotionGeneratorMode generator;
  std::function<void(RobotCommand&, double growing)> change;
  bool grows{false};
  Joints start{kReady};
};

class WrongCommand : public ErrorFlags, public ::testing::WithParamInterface<CommandRow> {};

TEST_P(WrongCommand, RaisesTheFlagsOfAllRulesThatItViolates) {
  const CommandRow& row = GetParam();
  standAt(row.start);
  move(row.generator, row.generator == MotionGeneratorMode::kNone
                          ? ControllerMode::kExternalController
                          : ControllerMode::kJointImpedance);
  const int ticks = drive(2000, [&](int i, const RobotState& state) {
    RobotCommand command = still(state);
    if (row.grows || i == 2) {
      row.change(command, 1e-3 * (i + 1));
    }
    return command;
  });
  expectReflex(row.flags);
  EXPECT_EQ(!row.grows, ticks == 3);
  EXPECT_LT(unit.state().q[0], 2.8983) << "braked before the limit of the measured joint";
}

constexpr auto kJoints = MotionGeneratorMode::kJointPosition;
constexpr auto kSpeeds = MotionGeneratorMode::kJointVelocity;
constexpr auto kPose = MotionGeneratorMode::kCartesianPosition;
constexpr auto kTwist = MotionGeneratorMode::kCartesianVelocity;
constexpr auto kTorque = MotionGeneratorMode::kNone;
// Seen on real robots: a jump of the joints raises 13, 14 and 15 together, a smaller one 14 and 15;
// one of the pose 18, 19 and 20 together with 30, the jerk of a joint, a smaller one 19, 20 and 30.
// Of the joints only the jerk counts then.
const CommandRow kCommandRows[] = {
    {"JointJump", {13, 14, 15}, kJoints, [](auto& c, double) { c.q_c[2] += 0.01; }},
    {"SmallJointJump", {14, 15}, kJoints, [](auto& c, double) { c.q_c[2] += 1e-4; }},
    // One whose derivatives overflow is beyond the range as well.
    {"Overflow", {12, 13, 14, 15}, kJoints, [](auto& c, double) { c.q_c[2] += 1e300; }},
    {"PoseJump", {18, 19, 20, 30}, kPose, [](auto& c, double) { c.O_T_EE_c[14] += 0.01; }},
    {"SmallPoseJump", {19, 20, 30}, kPose, [](auto& c, double) { c.O_T_EE_c[14] += 1e-4; }},
    {"JumpWithElbow",
     {17, 18, 19, 20, 30},
     kPose,
     [](auto& c, double) {
       c.valid_elbow = true;
       c.elbow_c[0] += 0.01;
       c.O_T_EE_c[14] += 0.01;
     }},
    {"TorqueJump", {32}, kTorque, [](auto& c, double) { c.tau_J_d[0] = 1.01; }},
    {"JointsNotFinite", {13}, kJoints, [](auto& c, double) { c.q_c[3] = NAN; }},
    {"VelocitiesNotFinite", {13}, kSpeeds, [](auto& c, double) { c.dq_c[3] = INFINITY; }},
    {"PoseNotFinite", {31}, kPose, [](auto& c, double) { c.O_T_EE_c[12] = NAN; }},
    {"TwistNotFinite", {18}, kTwist, [](auto& c, double) { c.O_dP_EE_c[2] = INFINITY; }},
    {"TorqueNotFinite", {32}, kTorque, [](auto& c, double) { c.tau_J_d[3] = NAN; }},
    {"JointEnd",
     {12},
     kSpeeds,
     [](auto& c, double t) { c.dq_c[0] = 0.3 * t; },
     true,
     {{2.88, -0.785, 0, -2.356, 0, 1.571, 0.785}}},
    // Inverse kinematics reaches the end of joint 7.
    {"SolvedEnd",
     {27},
     kTwist,
     [](auto& c, double t) { c.O_dP_EE_c[5] = -0.3 * t; },
     true,
     {{0, -0.785, 0, -2.356, 0, 1.571, 2.88}}},
    // Sideways, 0.31 m from the first axis: a slow motion of the hand is fast for the joint.
    {"SolvedVelocity", {28}, kTwist, [](auto& c, double t) { c.O_dP_EE_c[1] = 1.5 * t; }, true},
    // Seen on real FERs: 13 m/s^2 at 6500 m/s^3, which the hand may do, and joint 1 may not.
    {"SolvedAcceleration",
     {29, 30},
     kTwist,
     [](auto& c, double t) { c.O_dP_EE_c[1] = 12.96 * t - 0.00648; },
     true}};
INSTANTIATE_TEST_SUITE_P(Rows, WrongCommand, ::testing::ValuesIn(kCommandRows),
                         [](const auto& row) { return row.param.name; });

// FER and FR3: the speed that a client's joint velocities reach before they end the motion.
TEST_F(ErrorFlags, LimitsAreThoseOfTheVersion) {
  for (const auto& [version, limit] : {std::pair{5U, 2.175}, std::pair{10U, 2.62}}) {
    parameters.protocol_version = version;
    standAt(kReady);
    ignoreCollisions();
    move(MotionGeneratorMode::kJointVelocity, ControllerMode::kJointImpedance);
    drive(1000, [](int i, const RobotState&) {
      RobotCommand command;
      command.dq_c[0] = 5e-3 * (i + 1);
      return command;
    });
    expectReflex({13});
    EXPECT_NEAR(limit, unit.state().dq_d[0], 0.025);
    EXPECT_FALSE(unit.request(codec::AutomaticErrorRecoveryRequest{}));
    EXPECT_EQ(Status::kSuccess, waitFor(PendingAnswer::kRecovery));
    EXPECT_EQ(std::vector<int>{}, raised());
  }
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
      expectReflex({1});
      EXPECT_NEAR(0.0, unit.state().O_T_EE[13], 1e-3);
    } else {
      EXPECT_TRUE(raised().empty());
      EXPECT_LT(unit.state().O_T_EE[13], -0.03);
    }
  }
}

TEST_F(ErrorFlags, SelfCollision) {
  // Torque control of protocols 3 to 9 comes with joint velocities of zero: the desired joint
  // positions stay where the motion began, while the torques move the arm.
  constexpr std::size_t kJoint = 3;
  Joints near{{0, 1.6, 0, -2.0, 0, 0.3, 0}};
  SelfCollision geometry(true);
  while (geometry.closest(parameters.model, near).distance > 0.007) {
    near[kJoint] -= 1e-3;  // folds the hand back to the upper arm
    ASSERT_GT(near[kJoint], -3.0);
  }
  for (const auto& [generator, controller] :
       {std::pair{MotionGeneratorMode::kJointVelocity, ControllerMode::kJointImpedance},
        std::pair{MotionGeneratorMode::kNone, ControllerMode::kExternalController},
        std::pair{MotionGeneratorMode::kJointVelocity, ControllerMode::kExternalController},
        std::pair{MotionGeneratorMode::kJointPosition, ControllerMode::kExternalController},
        std::pair{MotionGeneratorMode::kCartesianVelocity, ControllerMode::kExternalController}}) {
    standAt(near);
    ignoreCollisions();
    move(generator, controller);
    const bool external = controller == ControllerMode::kExternalController;
    drive(2000, [&](int i, const RobotState& state) {
      RobotCommand command = still(state);
      command.dq_c[kJoint] = external ? 0.0 : -0.5e-3 * (i + 1);
      command.tau_J_d[kJoint] = -std::min(0.1 * i, 2.0);
      return command;
    });
    SCOPED_TRACE(static_cast<int>(generator));
    expectReflex({2});
    const LinkPair& pair = unit.status().self_collision;
    EXPECT_LT(pair.distance, 0.0);
    EXPECT_GT(pair.distance, -1e-3) << "detected late";
    EXPECT_GE(pair.second - pair.first, 2);
  }
}

TEST_F(ErrorFlags, JointAndCartesianReflex) {
  for (const int flag : {6, 7}) {
    arm.push.fill(0.0);
    standAt(kReady);
    CollisionThresholds thresholds = highThresholds();
    if (flag == 6) {
      thresholds.upper_torque = parameters.nominal.upper_torque;
    } else {
      thresholds.upper_force = parameters.nominal.upper_force;
    }
    unit.request(collisionRequest(thresholds, thresholds));
    moveJoints();
    arm.push = {{0, 60, 0, 0, 0, 0}};
    drive(200, [](int, const RobotState& state) { return still(state); });
    expectReflex({flag});
    EXPECT_EQ(flag == 6, unit.state().joint_collision != Joints{});
    EXPECT_EQ(flag == 7 ? 1.0 : 0.0, unit.state().cartesian_collision[1]);
  }
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
    drive(500, [&](int i, const RobotState& state) {
      RobotCommand command = still(state);
      command.motion_generation_finished = i == 400;
      return command;
    });
    expectReflex({flag});
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
  expectReflex({10});
}

TEST_F(ErrorFlags, FirstCommandOfAMotion) {
  // A load bends the arm away from q_d, with which the command is compared.
  ignoreCollisions();
  arm.push = {{0, 0, -20, 0, 0, 0}};
  run(1000);
  ASSERT_GT(largestDifference(unit.state().q, unit.state().q_d), 2e-3);
  moveJoints();
  drive(3, [](int, const RobotState& state) { return still(state); });
  EXPECT_TRUE(raised().empty());
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
  expectReflex({23});
}

TEST_F(ErrorFlags, TwentyLostCommandsButNotNineteen) {
  for (const ControllerMode controller :
       {ControllerMode::kJointImpedance, ControllerMode::kExternalController}) {
    standAt(kReady);
    move(MotionGeneratorMode::kJointPosition, controller);
    drive(50, [](int, const RobotState& state) { return still(state); });
    run(19);
    EXPECT_TRUE(raised().empty());
    drive(1, [](int, const RobotState& state) { return still(state); });
    run(19);
    EXPECT_TRUE(raised().empty());
    EXPECT_NEAR(0.62, unit.state().control_command_success_rate, 0.06);
    run(1);
    expectReflex({25});
    EXPECT_EQ(0.0, unit.state().control_command_success_rate);
  }
}

TEST_F(ErrorFlags, WaitsAThousandTicksForTheFirstCommand) {
  moveJoints();
  run(999);
  EXPECT_TRUE(raised().empty());
  run(1);
  expectReflex({25});
}

}  // namespace

}  // namespace franka_sim::test
