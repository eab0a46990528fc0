// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Targets to which the robot plans its own motion.
#include <ros_test/eventually.h>

#include <cmath>
#include <franka/async_control/async_position_control_handler.hpp>

#include "robot_fixture.h"

namespace franka_test {
namespace {

using Handler = franka::AsyncPositionControlHandler;
using franka::TargetStatus;

const std::vector<double> kVelocities(7, 0.5);
const std::vector<double> kTarget{0.1, -0.9, 0.2, -2.2, 0.3, 1.5, 0.7};

std::shared_ptr<franka::Robot> share(const FakeRobot& fake) {
  return std::make_shared<franka::Robot>(fake.address(), franka::RealtimeConfig::kIgnore);
}

TEST(AsyncPositions, MoveFromTargetToTarget) {
  FakeRobot fake(10);
  const auto robot = share(fake);
  const auto [handler, error] = Handler::configure(robot, {kVelocities});
  ASSERT_NE(nullptr, handler) << *error;
  EXPECT_EQ(TargetStatus::kIdle, handler->getTargetFeedback().status);
  const auto first = handler->setJointPositionTarget({kTarget});
  EXPECT_TRUE(first.was_successful);
  EXPECT_EQ(36u, first.motion_uuid.size());
  // The fake robot jumps, and is at rest only when it receives the same target again.
  while (handler->getTargetFeedback().status != TargetStatus::kExecuting) {
  }
  const auto second = handler->setJointPositionTarget({kTarget});
  EXPECT_NE(first.motion_uuid, second.motion_uuid);
  for (int i = 0; i < 100 && handler->getTargetFeedback().status != TargetStatus::kTargetReached;
       i++) {
  }
  EXPECT_EQ(TargetStatus::kTargetReached, handler->getTargetFeedback().status);
  handler->stopControl();
  EXPECT_EQ(1, fake.count(Command::kStopMove));
  EXPECT_EQ(TargetStatus::kAborted, handler->getTargetFeedback().status);
  EXPECT_FALSE(handler->setJointPositionTarget({kTarget}).was_successful);
  EXPECT_NO_THROW(robot->readOnce());
}

TEST(AsyncPositions, AreReachedWithinTheToleranceAndAtRest) {
  FakeRobot fake(10);
  const auto handler = Handler::configure(share(fake), {kVelocities, 0.01}).handler;
  ASSERT_TRUE(handler->setJointPositionTarget({kTarget}).was_successful);
  franka::RobotState state;
  std::copy(kTarget.begin(), kTarget.end(), state.q_d.begin());
  const auto status = [&] { return handler->getTargetFeedback(state).status; };
  EXPECT_EQ(TargetStatus::kTargetReached, status());
  state.q_d[0] += 0.0099;
  EXPECT_EQ(TargetStatus::kTargetReached, status());
  state.q_d[1] += 0.0020;  // the norm counts: 0.0101
  EXPECT_EQ(TargetStatus::kExecuting, status());
  state.q_d[1] -= 0.0020;
  state.dq_d[6] = 0.0099;
  EXPECT_EQ(TargetStatus::kTargetReached, status());
  state.dq_d[6] = 0.0101;
  EXPECT_EQ(TargetStatus::kExecuting, status());
}

TEST(AsyncPositions, ReportErrors) {
  FakeRobot old(5), fake(10);
  EXPECT_NE(std::string::npos,
            Handler::configure(share(old), {kVelocities}).error_message->find("5.9.0"));
  EXPECT_FALSE(Handler::configure(nullptr, {kVelocities}).handler);
  const auto robot = share(fake);
  EXPECT_FALSE(Handler::configure(robot, {{1.0}}).handler);
  EXPECT_FALSE(Handler::configure(robot, {kVelocities, 0.0}).handler);
  const auto handler = Handler::configure(robot, {kVelocities}).handler;
  ASSERT_NE(nullptr, handler);
  EXPECT_FALSE(Handler::configure(robot, {kVelocities}).handler);  // busy
  EXPECT_FALSE(handler->setJointPositionTarget({{1, 2, 3}}).was_successful);
  std::vector<double> bad = kTarget;
  bad[3] = std::nan("");
  EXPECT_FALSE(handler->setJointPositionTarget({bad}).was_successful);
}

class AsyncAbort : public ::testing::Test {
 protected:
  /// A motion that the robot ends at its first target, before the client has noticed.
  AsyncAbort() {
    fake_.script([](FakeRobot::Script& s) {
      s.abort_after = 1;
      s.abort_errors = {7};
    });
    EXPECT_TRUE(handler_->setJointPositionTarget({kTarget}).was_successful);
    EXPECT_TRUE(ros_test::eventually(
        [this] { return fake_.state().robot_mode == franka_core::RobotMode::kReflex; }));
  }

  void expectAborted(const std::optional<std::string>& message) {
    ASSERT_TRUE(message);
    EXPECT_NE(std::string::npos, message->find("cartesian_reflex")) << *message;
    const auto feedback = handler_->getTargetFeedback();
    EXPECT_EQ(TargetStatus::kAborted, feedback.status);
    EXPECT_EQ(message, feedback.error_message);
    const auto result = handler_->setJointPositionTarget({kTarget});
    EXPECT_FALSE(result.was_successful);
    EXPECT_EQ(message, result.error_message);
    EXPECT_EQ(1u, fake_.exchanges().size());
    EXPECT_NO_THROW(robot_->readOnce());
  }

  FakeRobot fake_{10};
  std::shared_ptr<franka::Robot> robot_{share(fake_)};
  std::shared_ptr<Handler> handler_{Handler::configure(robot_, {kVelocities}).handler};
};

TEST_F(AsyncAbort, NextTargetFails) {
  const auto result = handler_->setJointPositionTarget({kTarget});
  EXPECT_FALSE(result.was_successful);
  EXPECT_EQ("", result.motion_uuid);
  expectAborted(result.error_message);
}

TEST_F(AsyncAbort, StateReportsIt) {
  franka::RobotState state;
  state.robot_mode = franka::RobotMode::kIdle;  // from before the motion
  EXPECT_EQ(TargetStatus::kExecuting, handler_->getTargetFeedback(state).status);
  state.robot_mode = franka::RobotMode::kReflex;
  state.time = franka::Duration(fake_.state().message_id);
  const auto feedback = handler_->getTargetFeedback(state);
  EXPECT_EQ(TargetStatus::kAborted, feedback.status);
  expectAborted(feedback.error_message);
}

}  // namespace
}  // namespace franka_test
