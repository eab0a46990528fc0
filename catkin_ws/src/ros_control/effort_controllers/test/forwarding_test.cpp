// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Controllers that forward commands, of all three interfaces.
#include <rt_guard/rt_guard.h>
#include <std_msgs/Float64MultiArray.h>

#include <cmath>
#include <limits>

#include "three_joint_robot.h"

using testing::HasSubstr;
using three_joints::kArm;
using three_joints::kSlide;
using three_joints::kWheel;
using three_joints::LogCatcher;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Forwarding : public three_joints::ControllerTest {
 protected:
  static std_msgs::Float64MultiArray several(const std::vector<double>& values) {
    std_msgs::Float64MultiArray message;
    message.data = values;
    return message;
  }
};

}  // namespace

TEST_F(Forwarding, PositionStartsAtTheMeasuredOne) {
  ASSERT_TRUE(load("position_controllers/JointPositionController", "wheel"));
  start();
  EXPECT_EQ(0.2, robot_.position_command_[kWheel]);
  const ros::Publisher publisher = commander<std_msgs::Float64>();
  publisher.publish(one(4.5));
  EXPECT_TRUE(stepsUntil([&] { return robot_.position_command_[kWheel] == 4.5; }));
  stop();
  EXPECT_EQ(4.5, robot_.position_command_[kWheel]);
}

TEST_F(Forwarding, CommandsBeforeTheStartAreDropped) {
  ASSERT_TRUE(load("position_controllers/JointPositionController", "arm"));
  start();
  const ros::Publisher publisher = commander<std_msgs::Float64>();
  publisher.publish(one(1.5));
  ASSERT_TRUE(stepsUntil([&] { return robot_.position_command_[kArm] == 1.5; }));
  stop();
  robot_.position_[kArm] = -0.7;
  start();
  EXPECT_EQ(-0.7, robot_.position_command_[kArm]);
}

TEST_F(Forwarding, VelocityStartsAndEndsAtZero) {
  robot_.velocity_command_[kSlide] = 9.0;
  ASSERT_TRUE(load("velocity_controllers/JointVelocityController", "slide"));
  start();
  EXPECT_EQ(0.0, robot_.velocity_command_[kSlide]);
  const ros::Publisher publisher = commander<std_msgs::Float64>();
  publisher.publish(one(-2.0));
  ASSERT_TRUE(stepsUntil([&] { return robot_.velocity_command_[kSlide] == -2.0; }));
  stop();
  EXPECT_EQ(0.0, robot_.velocity_command_[kSlide]);
  start();
  EXPECT_EQ(0.0, robot_.velocity_command_[kSlide]);
}

TEST_F(Forwarding, EffortStartsAndEndsAtZeroAndRefusesNonFiniteCommands) {
  ASSERT_TRUE(load("effort_controllers/JointEffortController", "arm"));
  robot_.effort_command_[kArm] = 9.0;
  start();
  EXPECT_EQ(0.0, robot_.effort_command_[kArm]);
  const ros::Publisher publisher = commander<std_msgs::Float64>();
  publisher.publish(one(3.0));
  ASSERT_TRUE(stepsUntil([&] { return robot_.effort_command_[kArm] == 3.0; }));
  LogCatcher log;
  publisher.publish(one(kNan));
  ASSERT_TRUE(stepsUntil([&] { return log.text().find("joint 'arm'") != std::string::npos; }));
  EXPECT_THAT(log.text(), HasSubstr("not a finite number"));
  step();
  EXPECT_EQ(3.0, robot_.effort_command_[kArm]);
  stop();
  EXPECT_EQ(0.0, robot_.effort_command_[kArm]);
}

TEST_F(Forwarding, GroupOfPositionsKeepsItsOrder) {
  ASSERT_TRUE(load("position_controllers/JointGroupPositionController",
                   three_joints::Names{"slide", "arm"}));
  start();
  EXPECT_EQ(0.1, robot_.position_command_[kSlide]);
  EXPECT_EQ(0.3, robot_.position_command_[kArm]);
  const ros::Publisher publisher = commander<std_msgs::Float64MultiArray>();
  publisher.publish(several({5.0, 6.0}));
  EXPECT_TRUE(stepsUntil([&] { return robot_.position_command_[kSlide] == 5.0; }));
  EXPECT_EQ(6.0, robot_.position_command_[kArm]);
  EXPECT_EQ(0.0, robot_.position_command_[kWheel]);
}

TEST_F(Forwarding, GroupRefusesWrongSizesAndNonFiniteCommands) {
  ASSERT_TRUE(load("velocity_controllers/JointGroupVelocityController",
                   three_joints::Names{"arm", "wheel"}));
  start();
  const ros::Publisher publisher = commander<std_msgs::Float64MultiArray>();
  publisher.publish(several({1.0, 2.0}));
  ASSERT_TRUE(stepsUntil([&] { return robot_.velocity_command_[kArm] == 1.0; }));
  LogCatcher log;
  publisher.publish(several({1.0, 2.0, 3.0}));
  ASSERT_TRUE(stepsUntil([&] { return !log.text().empty(); }));
  EXPECT_THAT(log.text(), HasSubstr("Dimension of command (3)"));
  publisher.publish(several({7.0, std::numeric_limits<double>::infinity()}));
  ASSERT_TRUE(stepsUntil([&] { return log.text().find("joint 'wheel'") != std::string::npos; }));
  EXPECT_EQ(1.0, robot_.velocity_command_[kArm]);
  EXPECT_EQ(2.0, robot_.velocity_command_[kWheel]);
  stop();
  EXPECT_EQ(0.0, robot_.velocity_command_[kArm]);
  EXPECT_EQ(0.0, robot_.velocity_command_[kWheel]);
}

TEST_F(Forwarding, GroupOfEffortsStartsAtZero) {
  robot_.effort_command_ = {{1.0, 2.0, 3.0}};
  ASSERT_TRUE(load("effort_controllers/JointGroupEffortController",
                   three_joints::Names{"arm", "wheel", "slide"}));
  start();
  EXPECT_THAT(robot_.effort_command_, testing::Each(0.0));
  const ros::Publisher publisher = commander<std_msgs::Float64MultiArray>();
  publisher.publish(several({1.0, 2.0, 3.0}));
  EXPECT_TRUE(stepsUntil([&] { return robot_.effort_command_[kSlide] == 3.0; }));
  EXPECT_EQ(2.0, robot_.effort_command_[kWheel]);
}

TEST_F(Forwarding, RefusesMissingUnknownAndDuplicateJoints) {
  LogCatcher log;
  nh_.setParam("c/type", "effort_controllers/JointEffortController");
  EXPECT_FALSE(manager_.loadController("c"));
  EXPECT_THAT(log.text(), HasSubstr("No joint given (namespace: /RefusesMissing"));
  EXPECT_FALSE(load("velocity_controllers/JointVelocityController", "leg"));
  EXPECT_THAT(log.text(), HasSubstr("leg"));
  const std::string group = "position_controllers/JointGroupPositionController";
  nh_.setParam("c/type", group);
  EXPECT_FALSE(manager_.loadController("c"));
  EXPECT_THAT(log.text(), HasSubstr("Failed to getParam 'joints'"));
  EXPECT_FALSE(load(group, three_joints::Names{"arm", "arm"}));
  EXPECT_THAT(log.text(), HasSubstr("stands twice"));
}

TEST_F(Forwarding, EveryControllerClaimsItsJoint) {
  ASSERT_TRUE(load("effort_controllers/JointEffortController", "arm"));
  nh_.setParam("other/type", "effort_controllers/JointGroupEffortController");
  nh_.setParam("other/joints", three_joints::Names{"wheel", "arm"});
  ASSERT_TRUE(manager_.loadController("other"));
  start();
  EXPECT_FALSE(doSwitch({"other"}, {}));
  EXPECT_TRUE(doSwitch({"other"}, {"c"}));
}

// Start, run and stop of every plugin of the three packages, in the loop's thread.
TEST_F(Forwarding, NoControllerAllocatesOrLocksInTheLoop) {
  int count = 0;
  for (const std::string type :
       {"position_controllers/JointPositionController",
        "position_controllers/JointGroupPositionController",
        "velocity_controllers/JointVelocityController",
        "velocity_controllers/JointPositionController",
        "velocity_controllers/JointGroupVelocityController",
        "effort_controllers/JointEffortController", "effort_controllers/JointPositionController",
        "effort_controllers/JointVelocityController",
        "effort_controllers/JointGroupEffortController",
        "effort_controllers/JointGroupPositionController"}) {
    const std::string name = "g" + std::to_string(count++);
    nh_.setParam(name + "/type", type);
    nh_.setParam(name + "/joint", "arm");
    nh_.setParam(name + "/joints", three_joints::Names{"arm", "wheel", "slide"});
    setGains(name + "/pid", 1.0, 1.0, 1.0);
    for (const std::string joint : {"arm", "wheel", "slide"}) {
      setGains(name + "/" + joint + "/pid", 1.0, 1.0, 1.0);
    }
    ASSERT_TRUE(manager_.loadController(name)) << type;
    controller_interface::ControllerBase* controller = manager_.getControllerByName(name);
    ASSERT_NE(nullptr, controller);
    rt_guard::Scope scope;
    controller->startRequest(time_);
    for (int i = 0; i < 100; ++i) {
      controller->updateRequest(time_, period_);
    }
    controller->stopRequest(time_);
    EXPECT_EQ(0u, scope.allocations()) << type;
    EXPECT_EQ(0u, scope.locks()) << type;
  }
}
