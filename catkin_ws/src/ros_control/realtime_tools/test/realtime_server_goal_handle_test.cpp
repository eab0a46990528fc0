// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/realtime_server_goal_handle.h"

#include <actionlib/TestAction.h>
#include <actionlib/client/action_client.h>
#include <actionlib/server/action_server.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>
#include <rt_guard/rt_guard.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>

namespace {

typedef realtime_tools::RealtimeServerGoalHandle<actionlib::TestAction> Handle;
typedef actionlib::ActionClient<actionlib::TestAction> Client;
typedef actionlib::ActionServer<actionlib::TestAction> Server;

template <class Condition>
bool eventually(Condition condition) {
  return ros_test::eventually([&] {
    ros::spinOnce();
    return condition();
  });
}

/// A server that accepts every goal, and a client that has sent one.
class RealtimeServerGoalHandleTest : public testing::Test {
 protected:
  RealtimeServerGoalHandleTest()
      : server_(
            node_, "goal_handle_test",
            [this](Server::GoalHandle goal) {
              goal.setAccepted();
              handle_ = std::make_unique<Handle>(goal);
            },
            [](Server::GoalHandle /*goal*/) {}, false),
        client_("goal_handle_test") {
    server_.start();
  }

  void SetUp() override {
    ASSERT_TRUE(eventually([this] { return client_.isServerConnected(); }));
    goal_ = client_.sendGoal(
        actionlib::TestGoal(), boost::function<void(Client::GoalHandle)>(),
        [this](Client::GoalHandle /*goal*/, const actionlib::TestFeedbackConstPtr& feedback) {
          feedback_ = feedback->feedback;
          ++feedbacks_;
        });
    ASSERT_TRUE(eventually([this] { return handle_ != nullptr; }));
    ASSERT_TRUE(eventually([this] {
      return goal_.getCommState() == actionlib::CommState(actionlib::CommState::ACTIVE);
    }));
  }

  /// The goal's end as received by the client.
  std::string endSeen() {
    handle_->runNonRealtime(ros::TimerEvent());
    EXPECT_TRUE(eventually([this] {
      return goal_.getCommState() == actionlib::CommState(actionlib::CommState::DONE);
    }));
    return goal_.getTerminalState().toString();
  }

  std::uint8_t status() { return handle_->gh_.getGoalStatus().status; }

  ros::NodeHandle node_;
  std::unique_ptr<Handle> handle_;
  Server server_;
  Client client_;
  Client::GoalHandle goal_;
  int feedback_{0};
  int feedbacks_{0};
};

}  // namespace

TEST_F(RealtimeServerGoalHandleTest, IsValidOnlyWithAGoal) {
  EXPECT_TRUE(handle_->valid());
  Handle::GoalHandle none;
  Handle empty(none);
  EXPECT_FALSE(empty.valid());
  ASSERT_NE(nullptr, empty.preallocated_result_);
  ASSERT_NE(nullptr, empty.preallocated_feedback_);
  empty.runNonRealtime(ros::TimerEvent());
}

TEST_F(RealtimeServerGoalHandleTest, UsesTheMessagesGiven) {
  const actionlib::TestResultPtr result(new actionlib::TestResult);
  const actionlib::TestFeedbackPtr feedback(new actionlib::TestFeedback);
  Handle given(handle_->gh_, result, feedback);
  EXPECT_EQ(result, given.preallocated_result_);
  EXPECT_EQ(feedback, given.preallocated_feedback_);
}

TEST_F(RealtimeServerGoalHandleTest, NothingEndsBeforeTheTimer) {
  handle_->setSucceeded();
  EXPECT_EQ(actionlib_msgs::GoalStatus::ACTIVE, status());
  EXPECT_EQ("SUCCEEDED", endSeen());
}

TEST_F(RealtimeServerGoalHandleTest, TheFirstRequestWinsAndItsResultArrives) {
  handle_->preallocated_result_->result = 7;
  handle_->setAborted(handle_->preallocated_result_);
  handle_->setSucceeded();
  handle_->setCanceled();
  EXPECT_EQ("ABORTED", endSeen());
  EXPECT_EQ(7, goal_.getResult()->result);
}

TEST_F(RealtimeServerGoalHandleTest, CancelsOnlyWhilePreempting) {
  handle_->setCanceled();
  handle_->runNonRealtime(ros::TimerEvent());
  EXPECT_EQ(actionlib_msgs::GoalStatus::ACTIVE, status());
  goal_.cancel();
  ASSERT_TRUE(eventually([this] { return status() == actionlib_msgs::GoalStatus::PREEMPTING; }));
  EXPECT_EQ("PREEMPTED", endSeen());
}

TEST_F(RealtimeServerGoalHandleTest, SucceedsAlsoWhilePreempting) {
  goal_.cancel();
  ASSERT_TRUE(eventually([this] { return status() == actionlib_msgs::GoalStatus::PREEMPTING; }));
  handle_->setSucceeded();
  EXPECT_EQ("SUCCEEDED", endSeen());
}

TEST_F(RealtimeServerGoalHandleTest, SendsFeedbackWhileActiveAndWithTheEnd) {
  handle_->runNonRealtime(ros::TimerEvent());  // no feedback set yet
  handle_->preallocated_feedback_->feedback = 3;
  handle_->setFeedback(handle_->preallocated_feedback_);
  handle_->runNonRealtime(ros::TimerEvent());
  ASSERT_TRUE(eventually([this] { return feedbacks_ == 1; }));
  EXPECT_EQ(3, feedback_);
  handle_->setSucceeded();
  EXPECT_EQ("SUCCEEDED", endSeen());
  handle_->runNonRealtime(ros::TimerEvent());  // no longer active: no more feedback
  EXPECT_FALSE(handle_->gh_.getGoalStatus().status == actionlib_msgs::GoalStatus::ACTIVE);
}

TEST_F(RealtimeServerGoalHandleTest, RequestsNeitherAllocateNorLock) {
  {
    rt_guard::Scope scope;
    for (int i = 0; i < 1000; ++i) {
      handle_->setFeedback(handle_->preallocated_feedback_);
      handle_->setSucceeded(handle_->preallocated_result_);
      handle_->setAborted(handle_->preallocated_result_);
    }
    EXPECT_EQ(0u, scope.allocations());
    EXPECT_EQ(0u, scope.locks());
  }
  EXPECT_EQ("SUCCEEDED", endSeen());
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "realtime_server_goal_handle_test");
  ros::NodeHandle node;
  return RUN_ALL_TESTS();
}
