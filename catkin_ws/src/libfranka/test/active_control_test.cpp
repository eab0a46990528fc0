// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Motions that the program drives itself.
#include <franka/active_motion_generator.h>
#include <franka/active_torque_control.h>
#include <ros_test/eventually.h>

#include <cmath>
#include <limits>

#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::ActiveControlBase;
using franka::CartesianPose;
using franka::CartesianVelocities;
using franka::ControlException;
using franka::JointPositions;
using franka::JointVelocities;
using franka::Torques;
using Mode = research_interface::robot::Move::ControllerMode;

using Active = EveryVersion;

TEST_P(Active, TorquesAreSentUnchanged) {
  const auto robot = connect(fake);
  const std::unique_ptr<ActiveControlBase> motion = robot->startTorqueControl();
  uint64_t last = 0;
  for (int i = 0; i < 50; i++) {
    const auto [state, period] = motion->readOnce();
    EXPECT_EQ(i == 0 ? 0 : state.time.toMSec() - last, period.toMSec());
    last = state.time.toMSec();
    Torques torques(kTorques);
    torques.motion_finished = i == 49;
    motion->writeOnce(torques);
  }
  const auto exchanges = fake.exchanges();
  ASSERT_EQ(50u, exchanges.size());
  for (const auto& exchange : exchanges) {
    EXPECT_EQ(kTorques, exchange.command.tau_J_d);
  }
  EXPECT_EQ(GetParam() == 10, exchanges.back().command.torque_command_finished);
  EXPECT_EQ(GetParam() < 10, exchanges.back().command.motion_generation_finished);
  EXPECT_EQ(0, fake.count(Command::kStopMove));
  EXPECT_THROW(motion->readOnce(), ControlException);
  EXPECT_THROW(motion->writeOnce(Torques(kTorques)), ControlException);
  // The motion has ended, although its object still exists.
  EXPECT_NO_THROW(robot->readOnce());
}

template <typename Value, typename Start, typename Arrives>
void expectGenerator(FakeRobot& fake, const Value& value, Start start, Arrives arrives) {
  for (Mode mode : {Mode::kJointImpedance, Mode::kCartesianImpedance, Mode::kExternalController}) {
    const bool external = mode == Mode::kExternalController;
    const auto robot = connect(fake);
    const std::unique_ptr<ActiveControlBase> motion = start(*robot, mode);
    const auto move = std::get<franka_core::fci::MoveRequest>(fake.requests().back());
    EXPECT_EQ(static_cast<int>(mode), static_cast<int>(move.controller_mode));
    for (int i = 0; i < 5; i++) {
      motion->readOnce();
      Value v = value;
      v.motion_finished = i == 4;
      if (external) {
        EXPECT_THROW(motion->writeOnce(v), ControlException);
        motion->writeOnce(v, Torques(kTorques));
      } else {
        EXPECT_THROW(motion->writeOnce(v, Torques(kTorques)), ControlException);
        motion->writeOnce(v);
      }
    }
    const auto exchanges = fake.exchanges();
    ASSERT_EQ(5u, exchanges.size());
    for (const auto& exchange : exchanges) {
      EXPECT_TRUE(arrives(exchange.command));
      EXPECT_EQ(external ? kTorques : (std::array<double, 7>{}), exchange.command.tau_J_d);
    }
  }
}

TEST_P(Active, GeneratorCommandsAreSentUnchanged) {
  using franka::Robot;
  expectGenerator(
      fake, JointPositions(kJoints),
      [](Robot& r, Mode m) { return r.startJointPositionControl(m); },
      [](const auto& c) { return c.q_c == kJoints; });
  expectGenerator(
      fake, JointVelocities(kJoints),
      [](Robot& r, Mode m) { return r.startJointVelocityControl(m); },
      [](const auto& c) { return c.dq_c == kJoints; });
  expectGenerator(
      fake, CartesianPose(kPose, {0.1, 1.0}),
      [](Robot& r, Mode m) { return r.startCartesianPoseControl(m); },
      [](const auto& c) { return c.O_T_EE_c == kPose && c.valid_elbow && c.elbow_c[0] == 0.1; });
  expectGenerator(
      fake, CartesianVelocities(kTwist),
      [](Robot& r, Mode m) { return r.startCartesianVelocityControl(m); },
      [](const auto& c) { return c.O_dP_EE_c == kTwist && !c.valid_elbow; });
}

TEST_P(Active, ReadOnceThrowsAnAbort) {
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) {
    s.abort_after = 10;
    s.abort_errors = {25};
  });
  std::unique_ptr<ActiveControlBase> motion = robot->startTorqueControl();
  const std::string text = textOf<ControlException>([&] {
    while (true) {
      motion->readOnce();
      motion->writeOnce(Torques(kTorques));
    }
  });
  EXPECT_TRUE(startsWith(text,
                         "libfranka: Move command aborted: motion aborted by reflex! "
                         "[\"communication_constraints_violation\"]\n"))
      << text;
  // The robot's reply has been read; the error is thrown again at once.
  EXPECT_EQ(text, textOf<ControlException>([&] { motion->readOnce(); }));
  EXPECT_EQ(text, textOf<ControlException>([&] { motion->writeOnce(Torques(kTorques)); }));
  EXPECT_EQ(text, textOf<ControlException>([&] { motion->readOnce(); }));
  EXPECT_EQ(10u, fake.exchanges().size());
  motion.reset();
  EXPECT_EQ(1, fake.count(Command::kStopMove));
  EXPECT_NO_THROW(robot->readOnce());
}

TEST_P(Active, AnAbortAtTheEndIsThrownAgain) {
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) { s.end_at_finish = Status::kReflexAborted; });
  const auto motion = robot->startTorqueControl();
  motion->readOnce();
  const auto finish = [&] { motion->writeOnce(franka::MotionFinished(Torques(kTorques))); };
  const std::string text = textOf<ControlException>(finish);
  EXPECT_NE(std::string::npos, text.find("Motion finished commanded"));
  EXPECT_EQ(text, textOf<ControlException>([&] { motion->readOnce(); }));
  EXPECT_EQ(text, textOf<ControlException>(finish));
}

TEST_P(Active, AsynchronousMotionsNeedVersion10) {
  const auto robot = connect(fake);
  const std::vector<double> velocities(7, 0.5);
  const auto start = [&] {
    return robot->startAsyncJointPositionControl(Mode::kJointImpedance, velocities);
  };
  if (GetParam() < 10) {
    EXPECT_NE(std::string::npos, textOf<franka::CommandException>(start).find("5.9.0"));
    EXPECT_EQ(0, fake.count(Command::kMove));
    return;
  }
  // Without a command the next state comes after this time.
  fake.script([](FakeRobot::Script& s) { s.answer_timeout = std::chrono::milliseconds(20); });
  auto motion = start();
  const auto move = std::get<franka_core::fci::MoveRequest>(fake.requests().back());
  EXPECT_TRUE(move.use_async_motion_generator);
  EXPECT_EQ(0.5, move.maximum_velocity[6]);
  motion->readOnce();
  motion->writeOnce(JointPositions(kJoints));
  // Nothing needs to be sent until the next target.
  for (int i = 0; i < 5; i++) {
    motion->readOnce();
  }
  motion->writeOnce(franka::MotionFinished(JointPositions(kJoints)));
  for (const std::vector<double>& bad :
       {std::vector<double>{}, std::vector<double>(6, 1.0), std::vector<double>(7, 0.0),
        std::vector<double>(7, std::nan(""))}) {
    EXPECT_THROW(robot->startAsyncJointPositionControl(Mode::kJointImpedance, bad),
                 std::invalid_argument);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Active, ::testing::ValuesIn(kVersions), versionName);

TEST(ActiveLife, DestructionStopsTheRobotAndFreesIt) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  {
    const auto motion = robot->startJointVelocityControl(Mode::kJointImpedance);
    motion->readOnce();
    EXPECT_THROW(robot->readOnce(), franka::InvalidOperationException);
    EXPECT_THROW(robot->startTorqueControl(), franka::InvalidOperationException);
  }
  EXPECT_EQ(1, fake.count(Command::kStopMove));
  EXPECT_EQ(franka_core::RobotMode::kIdle, fake.state().robot_mode);
  EXPECT_NO_THROW(robot->readOnce());
}

TEST(ActiveLife, OutlivesTheRobotObject) {
  FakeRobot fake(5);
  auto robot = connect(fake);
  const auto motion = robot->startTorqueControl();
  robot.reset();
  for (int i = 0; i < 5; i++) {
    motion->readOnce();
    motion->writeOnce(i == 4 ? franka::MotionFinished(Torques(kTorques)) : Torques(kTorques));
  }
  EXPECT_EQ(5u, fake.exchanges().size());
}

TEST(ActiveLife, RefusedStartLeavesTheRobotFree) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) {
    s.replies[Command::kMove] = Status::kCommandNotPossibleRejected;
  });
  EXPECT_THROW(robot->startTorqueControl(), franka::CommandException);
  EXPECT_NO_THROW(robot->readOnce());
  EXPECT_EQ(0, fake.count(Command::kStopMove));
}

TEST(ActiveForm, MustFitTheMotion) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  const auto motion = robot->startTorqueControl();
  motion->readOnce();
  EXPECT_THROW(motion->writeOnce(JointPositions(kJoints)), ControlException);
  EXPECT_THROW(motion->writeOnce(JointVelocities(kJoints)), ControlException);
  EXPECT_THROW(motion->writeOnce(CartesianPose(kPose)), ControlException);
  EXPECT_THROW(motion->writeOnce(CartesianVelocities(kTwist)), ControlException);
  EXPECT_THROW(motion->writeOnce(JointPositions(kJoints), Torques(kTorques)), ControlException);
  EXPECT_THROW(motion->writeOnce(JointVelocities(kJoints), Torques(kTorques)), ControlException);
  EXPECT_THROW(motion->writeOnce(CartesianPose(kPose), Torques(kTorques)), ControlException);
  EXPECT_THROW(motion->writeOnce(CartesianVelocities(kTwist), Torques(kTorques)), ControlException);
  EXPECT_THROW(
      motion->writeOnce(Torques({std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0, 0, 0})),
      std::invalid_argument);
  EXPECT_NO_THROW(motion->writeOnce(Torques(kTorques)));
}

TEST(ActiveFaults, LostConnectionEndsReadOnceAndTheDestructor) {
  const ShortTimeouts timeouts;
  FakeRobot fake(5);
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) { s.silence_after = 5; });
  auto motion = robot->startTorqueControl();
  EXPECT_EQ("libfranka: UDP receive: Timeout", textOf<franka::NetworkException>([&] {
              while (true) {
                motion->readOnce();
                motion->writeOnce(Torques(kTorques));
              }
            }));
  motion.reset();
  EXPECT_TRUE(ros_test::eventually([&] { return fake.count(Command::kStopMove) == 1; }));
}

}  // namespace
}  // namespace franka_test
