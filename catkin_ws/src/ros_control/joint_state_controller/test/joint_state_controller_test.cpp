// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "joint_state_controller/joint_state_controller.h"

#include <controller_manager/controller_manager.h>
#include <gmock/gmock.h>
#include <hardware_interface/robot_hw.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>
#include <ros_test/log_catcher.h>
#include <rt_guard/rt_guard.h>

#include <array>
#include <mutex>
#include <string>
#include <vector>

using ros_test::eventually;
using ros_test::LogCatcher;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

class Robot : public hardware_interface::RobotHW {
 public:
  Robot() {
    const std::array<std::string, 3> names{"b", "a", "c"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      states_.registerHandle(hardware_interface::JointStateHandle(names[i], &position_[i],
                                                                  &velocity_[i], &effort_[i]));
    }
    registerInterface(&states_);
  }
  std::array<double, 3> position_{{1.0, 2.0, 3.0}}, velocity_{{4.0, 5.0, 6.0}},
      effort_{{7.0, 8.0, 9.0}};

 private:
  hardware_interface::JointStateInterface states_;
};

/// A controller "c" in a namespace named after the test; collects its messages.
class JointStateControllerTest : public testing::Test {
 protected:
  JointStateControllerTest()
      : nh_(testing::UnitTest::GetInstance()->current_test_info()->name()), manager_(&robot_, nh_) {
    nh_.deleteParam("c");  // for a master that outlives a run
    nh_.setParam("c/type", "joint_state_controller/JointStateController");
  }

  void load() {
    ASSERT_TRUE(manager_.loadController("c"));
    controller_ = manager_.getControllerByName("c");
    subscriber_ = nh_.subscribe<sensor_msgs::JointState>(
        "joint_states", 10000, [this](const sensor_msgs::JointStateConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          messages_.push_back(*message);
        });
    ASSERT_TRUE(eventually([&] { return subscriber_.getNumPublishers() > 0; }));
  }

  std::vector<sensor_msgs::JointState> messages() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }

  /// One cycle.
  void update(double time) { controller_->updateRequest(ros::Time(time), ros::Duration(0.001)); }
  /// One cycle, repeated until its message has arrived, because the controller does not publish
  /// while the publisher's thread still has the previous message.
  void publishAt(double time) {
    ASSERT_TRUE(eventually([&] {
      update(time);
      const auto all = messages();
      return !all.empty() && all.back().header.stamp == ros::Time(time);
    })) << time;
  }
  /// The times of all messages until now.
  std::vector<ros::Time> published() {
    std::vector<ros::Time> times;
    for (const sensor_msgs::JointState& message : messages()) {
      times.push_back(message.header.stamp);
    }
    return times;
  }

  Robot robot_;
  ros::NodeHandle nh_;
  controller_manager::ControllerManager manager_;
  controller_interface::ControllerBase* controller_{nullptr};
  std::mutex mutex_;
  std::vector<sensor_msgs::JointState> messages_;
  ros::Subscriber subscriber_;
};

}  // namespace

TEST_F(JointStateControllerTest, PublishesAllJointsInTheFirstCycle) {
  nh_.setParam("c/publish_rate", 100);
  load();
  controller_->startRequest(ros::Time(10.0));
  publishAt(10.001);
  const sensor_msgs::JointState message = messages().front();
  EXPECT_EQ(ros::Time(10.001), message.header.stamp);
  EXPECT_THAT(message.name, ElementsAre("a", "b", "c"));
  EXPECT_THAT(message.position, ElementsAre(2.0, 1.0, 3.0));
  EXPECT_THAT(message.velocity, ElementsAre(5.0, 4.0, 6.0));
  EXPECT_THAT(message.effort, ElementsAre(8.0, 7.0, 9.0));
}

TEST_F(JointStateControllerTest, PublishesRequestedJointsInOrderAndExtraJoints) {
  nh_.setParam("c/publish_rate", 50.0);
  nh_.setParam("c/joints", std::vector<std::string>{"c", "b"});
  XmlRpc::XmlRpcValue extra;
  extra[0]["name"] = "finger";
  extra[0]["position"] = 0.5;
  extra[0]["effort"] = 2;
  extra[1]["position"] = 1.0;  // no name
  extra[2]["name"] = "b";      // already exists
  extra[3]["name"] = "wrong";
  extra[3]["velocity"] = "fast";
  nh_.setParam("c/extra_joints", extra);
  LogCatcher log;
  load();
  EXPECT_THAT(log.text(), HasSubstr("An entry of extra_joints is skipped"));
  EXPECT_THAT(log.text(), HasSubstr("The extra joint 'b' is skipped"));
  EXPECT_THAT(log.text(),
              HasSubstr("The extra joint 'wrong' is skipped: its velocity is not a number"));
  controller_->startRequest(ros::Time(10.0));
  publishAt(10.001);
  const sensor_msgs::JointState message = messages().front();
  EXPECT_THAT(message.name, ElementsAre("c", "b", "finger"));
  EXPECT_THAT(message.position, ElementsAre(3.0, 1.0, 0.5));
  EXPECT_THAT(message.velocity, ElementsAre(6.0, 4.0, 0.0));
  EXPECT_THAT(message.effort, ElementsAre(9.0, 7.0, 2.0));
}

TEST_F(JointStateControllerTest, KeepsItsRate) {
  nh_.setParam("c/publish_rate", 250.0);
  load();
  controller_->startRequest(ros::Time(10.0));
  // Every 4 ms after the start; the first one in the first cycle.
  std::vector<ros::Time> due;
  for (int i = 1; i <= 40; ++i) {
    const double time = 10.0 + 0.001 * i;
    if (i == 1 || i % 4 == 0) {
      publishAt(time);
      due.emplace_back(time);
    } else {
      update(time);
    }
  }
  EXPECT_EQ(due, published());
}

TEST_F(JointStateControllerTest, SkipsMissedMessagesAndFollowsTimeBack) {
  nh_.setParam("c/publish_rate", 100.0);
  load();
  controller_->startRequest(ros::Time(10.0));
  publishAt(10.001);
  publishAt(15.0);  // five seconds were skipped
  update(15.001);
  update(15.009);
  publishAt(15.010);
  publishAt(2.0);  // the simulation was reset
  update(2.001);
  publishAt(2.010);
  EXPECT_THAT(published(), ElementsAre(ros::Time(10.001), ros::Time(15.0), ros::Time(15.010),
                                       ros::Time(2.0), ros::Time(2.010)));
}

TEST_F(JointStateControllerTest, ZeroRatePublishesNothing) {
  nh_.setParam("c/publish_rate", 0.0);
  load();
  controller_->startRequest(ros::Time(10.0));
  update(10.001);
  update(1000.0);
  // Only another controller's messages arrive.
  nh_.setParam("d/type", "joint_state_controller/JointStateController");
  nh_.setParam("d/publish_rate", 1000.0);
  ASSERT_TRUE(manager_.loadController("d"));
  controller_ = manager_.getControllerByName("d");
  controller_->startRequest(ros::Time(20.0));
  for (int i = 1; i <= 10; ++i) {
    publishAt(20.0 + 0.001 * i);
  }
  EXPECT_EQ(10u, messages().size());
}

TEST_F(JointStateControllerTest, ReportsMissingParameters) {
  LogCatcher log;
  EXPECT_FALSE(manager_.loadController("c"));
  EXPECT_THAT(log.text(), HasSubstr("Parameter 'publish_rate' not set"));
  nh_.setParam("c/publish_rate", 10.0);
  nh_.setParam("c/joints", 7);
  EXPECT_FALSE(manager_.loadController("c"));
  EXPECT_THAT(log.text(),
              HasSubstr("The parameter 'joints' (namespace: /ReportsMissingParameters/c) is "
                        "not a list of joint names"));
  nh_.setParam("c/joints", std::vector<std::string>{"leg"});
  EXPECT_FALSE(manager_.loadController("c"));
  EXPECT_THAT(log.text(), HasSubstr("leg"));
}

TEST_F(JointStateControllerTest, UpdatesWithoutAllocationOrLock) {
  nh_.setParam("c/publish_rate", 1000.0);
  load();
  rt_guard::Scope scope;
  controller_->startRequest(ros::Time(10.0));
  for (int i = 1; i <= 1000; ++i) {
    controller_->updateRequest(ros::Time(10.0 + 0.001 * i), ros::Duration(0.001));
  }
  controller_->stopRequest(ros::Time(12.0));
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  ros::init(argc, argv, "joint_state_controller_test");
  ros::NodeHandle keeps_ros_alive;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
