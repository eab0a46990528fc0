// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Commands of the hand from other threads.

#include <franka_sim_mujoco/gripper_mailbox.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace franka_sim_mujoco {
namespace {

class Mailbox : public testing::Test {
 protected:
  std::shared_ptr<GripperCommand> post(GripperCommand::Kind kind, double width = 0.04,
                                       double speed = 0.1) {
    auto command = std::make_shared<GripperCommand>();
    command->kind = kind;
    command->width = width;
    command->speed = speed;
    mailbox_.post(command);
    return command;
  }
  void tick() {
    mailbox_.serve(unit_);
    const auto force = unit_.step(fingers_, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {  // fingers of 0.1 kg
      fingers_.dq[i] += force[i] / 0.1 * 1e-3;
      fingers_.q[i] += fingers_.dq[i] * 1e-3;
    }
    mailbox_.settle(unit_);
  }
  GripperMailbox mailbox_;
  franka_sim::GripperUnit unit_{franka_sim::GripperParameters{}};
  franka_sim::HandMeasurement fingers_{{0.01, 0.01}, {0, 0}};
};

using Fate = GripperCommand::Fate;

TEST_F(Mailbox, ReportsTheOutcomeOfACommand) {
  const auto move = post(GripperCommand::Kind::kMove);
  EXPECT_EQ(Fate::kWaiting, move->fate);
  tick();
  EXPECT_EQ(Fate::kRunning, move->fate);
  for (int i = 0; i < 2000 && !move->isSettled(); ++i) {
    tick();
  }
  EXPECT_EQ(Fate::kSucceeded, move->fate);
  EXPECT_NEAR(0.04, unit_.width(), 5e-3);
}

TEST_F(Mailbox, NewCommandInterruptsWaitingAndRunningOnes) {
  const auto running = post(GripperCommand::Kind::kMove);
  tick();
  const auto waiting = post(GripperCommand::Kind::kHoming);
  const auto stop = post(GripperCommand::Kind::kStop);
  EXPECT_EQ(Fate::kInterrupted, waiting->fate) << "although the loop does not run";
  EXPECT_EQ(Fate::kRunning, running->fate);
  tick();
  EXPECT_EQ(Fate::kInterrupted, running->fate);
  EXPECT_EQ(Fate::kSucceeded, stop->fate);
}

TEST_F(Mailbox, RefusedCommandDoesNotInterrupt) {
  const auto running = post(GripperCommand::Kind::kMove);
  tick();
  const auto wrong = post(GripperCommand::Kind::kMove, std::nan(""));
  tick();
  EXPECT_EQ(Fate::kRefused, wrong->fate);
  EXPECT_EQ(Fate::kRunning, running->fate);
  mailbox_.interruptAll();
  EXPECT_EQ(Fate::kInterrupted, running->fate);
}

}  // namespace
}  // namespace franka_sim_mujoco
