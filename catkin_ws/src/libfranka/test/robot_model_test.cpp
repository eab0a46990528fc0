// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The model from the connection; its results are tested without a robot.
#include <franka/model.h>

#include "random_state.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

std::vector<std::uint8_t> toBytes(const std::string& text) { return {text.begin(), text.end()}; }

TEST(RobotModel, ComesFromTheDescription) {
  const std::string urdf = readData("fr3_hand.urdf");
  const franka::Model expected = franka::Model::fromUrdf(urdf);
  for (std::uint16_t version : {std::uint16_t{8}, std::uint16_t{10}}) {
    FakeRobot fake(version);
    fake.script([&urdf](FakeRobot::Script& s) { s.urdf = toBytes(urdf); });
    const auto robot = connect(fake);
    const franka::Model model = robot->loadModel();
    const franka::RobotState state = robot->readOnce();
    EXPECT_EQ(expected.pose(franka::Frame::kFlange, state),
              model.pose(franka::Frame::kFlange, state));
    EXPECT_EQ(expected.mass(state), model.mass(state));
    EXPECT_EQ(0, fake.count(Command::kLoadModelLibrary));
  }
}

TEST(RobotModel, IsRequestedIfTheVersionHasIt) {
  for (std::uint16_t version : kVersions) {
    FakeRobot fake(version);
    fake.script([](FakeRobot::Script& s) {
      s.urdf = toBytes("<robot/>");
      s.library = toBytes("no library");
    });
    const auto robot = connect(fake);
    const int before = fake.count(Command::kGetRobotModel);
    EXPECT_THROW(robot->loadModel(), franka::ModelException);
    EXPECT_EQ(version >= 8 ? 1 : 0, fake.count(Command::kGetRobotModel) - before);
    EXPECT_EQ(version <= 9 ? 1 : 0, fake.count(Command::kLoadModelLibrary));
  }
}

TEST(RobotModel, MayBeRefused) {
  FakeRobot fake(5);
  fake.script([](FakeRobot::Script& s) { s.replies[Command::kLoadModelLibrary] = Status::kError; });
  EXPECT_TRUE(startsWith(textOf<franka::ModelException>([&] { connect(fake)->loadModel(); }),
                         "libfranka: "));
}

}  // namespace
}  // namespace franka_test
