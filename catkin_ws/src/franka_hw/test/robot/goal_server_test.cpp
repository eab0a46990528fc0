// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The goals of an action: their order, and how each of them ends.
#include <actionlib_msgs/GoalStatus.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <franka_hw/goal_server.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "support.h"

namespace franka_hw_test {
namespace {

using Status = actionlib_msgs::GoalStatus;

/// An action whose goals run until release(), whatever is requested of them.
class GoalServerTest : public testing::Test {
 protected:
  using Server = franka_hw::GoalServer<franka_msgs::ErrorRecoveryAction>;

  void SetUp() override {
    server_.start();
    ASSERT_TRUE(eventually(
        [this] { return goals_.getNumSubscribers() == 1 && results_.getNumPublishers() == 1; }));
  }
  void TearDown() override { release_ = true; }

  void send(const std::string& id, double stamp = 100.0) {
    franka_msgs::ErrorRecoveryActionGoal goal;
    goal.goal_id.id = id;
    goal.goal_id.stamp = ros::Time(stamp);
    goals_.publish(goal);
  }
  void sendAndWaitUntilItRuns(const std::string& id) {
    const int before = begun_;
    send(id);
    ASSERT_TRUE(eventually([&] { return begun_ > before; }));
  }
  /// The status at the end of a goal; PENDING if it did not end.
  int endOf(const std::string& id) {
    eventually([&] { return ended(id); });
    const std::lock_guard<std::mutex> lock(mutex_);
    return ends_.count(id) == 1 ? ends_[id] : int{Status::PENDING};
  }
  bool ended(const std::string& id) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return ends_.count(id) == 1;
  }

  ros::NodeHandle nh_{FakeArm::freshNamespace()};
  std::mutex mutex_;
  std::map<std::string, int> ends_;
  std::atomic_bool release_{false}, impossible_{false};
  std::atomic_int begun_{0};
  ros::Publisher goals_ = nh_.advertise<franka_msgs::ErrorRecoveryActionGoal>("action/goal", 10);
  Server server_{nh_, "action",
                 [this](const auto& /*goal*/) {
                   begun_++;
                   eventually([this] { return release_.load(); });
                   server_.setSucceeded();
                 },
                 [this](const auto& /*goal*/, auto& /*result*/) {
                   return impossible_ ? "It cannot be carried out." : "";
                 }};
  ros::Subscriber results_ = nh_.subscribe<franka_msgs::ErrorRecoveryActionResult>(
      "action/result", 10, [this](const auto& result) {
        const std::lock_guard<std::mutex> lock(mutex_);
        ends_[result->status.goal_id.id] = result->status.status;
      });
};

TEST_F(GoalServerTest, AbortsAnImpossibleGoalWithoutEndingTheRunningOne) {
  sendAndWaitUntilItRuns("running");
  impossible_ = true;
  send("impossible");
  EXPECT_EQ(Status::ABORTED, endOf("impossible"));
  EXPECT_FALSE(server_.isPreemptRequested());
  EXPECT_FALSE(ended("running"));
  release_ = true;
  EXPECT_EQ(Status::SUCCEEDED, endOf("running"));
}

TEST_F(GoalServerTest, CarriesOutGoalsWithEarlierStamps) {
  release_ = true;
  send("before the clock jumped back", 1000.0);
  EXPECT_EQ(Status::SUCCEEDED, endOf("before the clock jumped back"));
  send("after it", 10.0);
  EXPECT_EQ(Status::SUCCEEDED, endOf("after it"));
}

TEST_F(GoalServerTest, ReplacesTheWaitingGoalByTheNewestOne) {
  sendAndWaitUntilItRuns("running");
  send("waiting");
  send("newest");
  EXPECT_EQ(Status::RECALLED, endOf("waiting"));
  EXPECT_TRUE(server_.isPreemptRequested());
  EXPECT_TRUE(server_.isNewGoalAvailable());
  release_ = true;
  EXPECT_EQ(Status::SUCCEEDED, endOf("running"));
  EXPECT_EQ(Status::SUCCEEDED, endOf("newest"));
}

TEST_F(GoalServerTest, CancelsTheWaitingGoalAtItsShutdown) {
  sendAndWaitUntilItRuns("running");
  send("waiting");
  ASSERT_TRUE(eventually([this] { return server_.isNewGoalAvailable(); }));
  std::thread shutdown([this] { server_.shutdown(); });
  EXPECT_EQ(Status::RECALLED, endOf("waiting"));
  EXPECT_FALSE(ended("running"));
  release_ = true;
  shutdown.join();
  EXPECT_EQ(Status::SUCCEEDED, endOf("running"));
  EXPECT_EQ(1, begun_);
}

// roscpp does not wait for the callback of a timer that is destroyed (own_callbacks.h).
TEST_F(GoalServerTest, EndsWhileItsStatusIsPublished) {
  nh_.setParam("actionlib_status_frequency", 1e5);
  std::atomic_int received{0};
  const ros::Subscriber status = nh_.subscribe<actionlib_msgs::GoalStatusArray>(
      "other/status", 10, [&](const auto& /*status*/) { received++; });
  for (int i = 0; i < 300; i++) {
    const int before = received;
    Server server(nh_, "other", [](const auto& /*goal*/) {});
    server.start();
    ASSERT_TRUE(eventually([&] { return received > before; }));
  }
}

}  // namespace
}  // namespace franka_hw_test
