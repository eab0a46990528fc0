// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Uses the library with a real connection to a fake gripper whose answers the test sets.
#include <fake_gripper.h>
#include <franka_gripper/franka_gripper.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <vector>

namespace {

using franka_test::FakeGripper;

/// A hand of version 3 that shows a width of 4 of 8 cm.
class FakeHand : public FakeGripper {
 public:
  FakeHand() : FakeGripper(3) {
    franka_core::fci::gripper::State state;
    state.width = 0.04;
    state.max_width = 0.08;
    franka_core::fci::gripper::StateBuffer buffer;
    franka_core::fci::gripper::encodeState(state, buffer);
    show({buffer.begin(), buffer.end()});
  }

  /// Expects that the last request has this command and these numbers.
  void expectLast(int command, const std::vector<double>& numbers) {
    const Bytes last = requests().back();
    EXPECT_EQ(command, last[0]);
    for (std::size_t i = 0; i < numbers.size(); i++) {
      double value;
      std::memcpy(&value, &last.at(10 + 8 * i), 8);
      EXPECT_EQ(numbers[i], value) << i;
    }
  }
};

TEST(GripperLibrary, ReadsTheState) {
  FakeHand hand;
  const franka::Gripper gripper(hand.address());
  franka::GripperState state;
  ASSERT_TRUE(franka_gripper::updateGripperState(gripper, &state));
  EXPECT_EQ(0.04, state.width);
  EXPECT_EQ(0.08, state.max_width);
}

TEST(GripperLibrary, ExecutesGoals) {
  FakeHand hand;
  const franka::Gripper gripper(hand.address());
  auto move = boost::make_shared<franka_gripper::MoveGoal>();
  move->width = 0.03;
  move->speed = 0.1;
  EXPECT_TRUE(franka_gripper::move(gripper, move));
  hand.expectLast(3, {0.03, 0.1});

  auto grasp = boost::make_shared<franka_gripper::GraspGoal>();
  grasp->width = 0.02;
  grasp->epsilon.inner = 0.001;
  grasp->epsilon.outer = 0.002;
  grasp->speed = 0.05;
  grasp->force = 30.0;
  EXPECT_TRUE(franka_gripper::grasp(gripper, grasp));
  hand.expectLast(2, {0.02, 0.001, 0.002, 0.05, 30.0});

  EXPECT_TRUE(franka_gripper::homing(gripper, boost::make_shared<franka_gripper::HomingGoal>()));
  hand.expectLast(1, {});
  EXPECT_TRUE(franka_gripper::stop(gripper, boost::make_shared<franka_gripper::StopGoal>()));
  hand.expectLast(4, {});
}

TEST(GripperLibrary, DistinguishesFailureAndRefusal) {
  FakeHand hand;
  const franka::Gripper gripper(hand.address());
  const auto goal = boost::make_shared<franka_gripper::MoveGoal>();
  hand.answer = FakeHand::Status::kUnsuccessful;
  EXPECT_FALSE(franka_gripper::move(gripper, goal));
  hand.answer = FakeHand::Status::kFail;
  EXPECT_THROW(franka_gripper::move(gripper, goal), franka::CommandException);
}

TEST(GripperLibrary, ReportsWhetherTheStateCanBeRead) {
  auto hand = std::make_unique<FakeHand>();
  const franka::Gripper gripper(hand->address());
  hand.reset();
  franka::GripperState state;
  bool read = true;
  for (int i = 0; i < 200 && read; i++) {  // states already sent arrive first
    read = franka_gripper::updateGripperState(gripper, &state);
  }
  EXPECT_FALSE(read);
}

}  // namespace
