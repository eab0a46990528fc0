// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Controllers that hold positions and velocities by a PID.
#include <control_msgs/JointControllerState.h>
#include <std_msgs/Float64MultiArray.h>

#include <cmath>
#include <limits>
#include <mutex>

#include "effort_controllers/joint_position_controller.h"
#include "effort_controllers/joint_velocity_controller.h"
#include "three_joint_robot.h"

using testing::HasSubstr;
using three_joints::eventually;
using three_joints::kArm;
using three_joints::kSlide;
using three_joints::kWheel;
using three_joints::LogCatcher;

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

class PidControllers : public three_joints::ControllerTest {
 protected:
  template <class Controller>
  Controller& controller() {
    return dynamic_cast<Controller&>(*manager_.getControllerByName("c"));
  }
};

}  // namespace

TEST_F(PidControllers, HoldsAPositionByAnEffort) {
  setGains("c/pid", 10.0, 0.0, 2.0);
  ASSERT_TRUE(load("effort_controllers/JointPositionController", "arm"));
  robot_.effort_command_[kArm] = 5.0;
  start();
  EXPECT_EQ(0.0, robot_.effort_command_[kArm]);  // where it stands
  const ros::Publisher publisher = commander<std_msgs::Float64>();
  publisher.publish(one(0.5));
  ASSERT_TRUE(stepsUntil([&] { return robot_.effort_command_[kArm] != 0.0; }));
  // The first step's derivative is that of the target's jump: 0.2 rad in 1 ms.
  EXPECT_NEAR(10.0 * 0.2 + 2.0 * 0.2 / 0.001, robot_.effort_command_[kArm], 1e-6);
  step();
  EXPECT_NEAR(10.0 * 0.2, robot_.effort_command_[kArm], 1e-9);
  LogCatcher log;
  publisher.publish(one(kNotANumber));
  ASSERT_TRUE(stepsUntil([&] { return !log.text().empty(); }));
  EXPECT_THAT(log.text(), HasSubstr("joint 'arm'"));
  step();
  EXPECT_NEAR(10.0 * 0.2, robot_.effort_command_[kArm], 1e-9);
  stop();
  EXPECT_EQ(0.0, robot_.effort_command_[kArm]);
}

TEST_F(PidControllers, LimitsTheTarget) {
  setGains("c/pid", 1.0);
  ASSERT_TRUE(load("effort_controllers/JointPositionController", "arm"));
  start();
  auto& held = controller<effort_controllers::JointPositionController>();
  held.setCommand(50.0);
  step();
  EXPECT_NEAR(2.0 - 0.3, robot_.effort_command_[kArm], 1e-12);
  held.setCommand(-50.0);
  step();
  EXPECT_NEAR(-1.0 - 0.3, robot_.effort_command_[kArm], 1e-12);
}

TEST_F(PidControllers, FollowsAMovingTarget) {
  setGains("c/pid", 10.0, 0.0, 2.0);
  ASSERT_TRUE(load("effort_controllers/JointPositionController", "arm"));
  start();
  robot_.velocity_[kArm] = 0.1;
  controller<effort_controllers::JointPositionController>().setCommand(0.4, 0.5);
  step();
  EXPECT_NEAR(10.0 * 0.1 + 2.0 * 0.4, robot_.effort_command_[kArm], 1e-9);
}

TEST_F(PidControllers, WheelTakesTheShortestTurnAndSlideTheDifference) {
  setGains("c/pid", 1.0);
  ASSERT_TRUE(load("velocity_controllers/JointPositionController", "wheel"));
  start();
  robot_.position_[kWheel] = 3.0;
  const ros::Publisher publisher = commander<std_msgs::Float64>();
  publisher.publish(one(-3.0));
  EXPECT_TRUE(stepsUntil(
      [&] { return std::abs(robot_.velocity_command_[kWheel] - (2.0 * M_PI - 6.0)) < 1e-9; }));
  stop();
  EXPECT_EQ(0.0, robot_.velocity_command_[kWheel]);
}

TEST_F(PidControllers, HoldsAVelocityByAnEffort) {
  setGains("c/pid", 3.0);
  ASSERT_TRUE(load("effort_controllers/JointVelocityController", "slide"));
  start();
  auto& held = controller<effort_controllers::JointVelocityController>();
  robot_.velocity_[kSlide] = 0.5;
  step();
  EXPECT_NEAR(-1.5, robot_.effort_command_[kSlide], 1e-12);
  held.setCommand(2.0);
  step();
  EXPECT_NEAR(4.5, robot_.effort_command_[kSlide], 1e-12);
  held.setCommand(kNotANumber);
  double command;
  held.getCommand(command);
  EXPECT_EQ(2.0, command);
  stop();
  EXPECT_EQ(0.0, robot_.effort_command_[kSlide]);
}

TEST_F(PidControllers, GroupHoldsEachJointByItsType) {
  setGains("c/arm/pid", 1.0);
  setGains("c/wheel/pid", 2.0);
  setGains("c/slide/pid", 4.0);
  ASSERT_TRUE(load("effort_controllers/JointGroupPositionController",
                   three_joints::Names{"slide", "wheel", "arm"}));
  robot_.effort_command_ = {{9.0, 9.0, 9.0}};
  start();
  EXPECT_THAT(robot_.effort_command_, testing::Each(0.0));
  const ros::Publisher publisher = commander<std_msgs::Float64MultiArray>();
  std_msgs::Float64MultiArray message;
  message.data = {70.0, 0.2 + 6.0, 0.0};
  publisher.publish(message);
  ASSERT_TRUE(stepsUntil([&] { return robot_.effort_command_[kArm] != 0.0; }));
  EXPECT_NEAR(4.0 * (0.5 - 0.1), robot_.effort_command_[kSlide], 1e-12);
  EXPECT_NEAR(2.0 * (6.0 - 2.0 * M_PI), robot_.effort_command_[kWheel], 1e-9);
  EXPECT_NEAR(1.0 * (0.0 - 0.3), robot_.effort_command_[kArm], 1e-12);
  LogCatcher log;
  message.data = {0.0};
  publisher.publish(message);
  ASSERT_TRUE(stepsUntil([&] { return !log.text().empty(); }));
  EXPECT_THAT(log.text(), HasSubstr("Dimension of command (1)"));
  EXPECT_NEAR(1.0 * (0.0 - 0.3), robot_.effort_command_[kArm], 1e-12);
  stop();
  EXPECT_THAT(robot_.effort_command_, testing::Each(0.0));
}

TEST_F(PidControllers, GainsAreReadAndSet) {
  setGains("c/pid", 1.0, 2.0, 3.0);
  nh_.setParam("c/pid/i_clamp", 4.0);
  ASSERT_TRUE(load("effort_controllers/JointVelocityController", "arm"));
  auto& held = controller<effort_controllers::JointVelocityController>();
  EXPECT_EQ("arm", held.getJointName());
  double p, i, d, i_max, i_min;
  bool antiwindup;
  held.getGains(p, i, d, i_max, i_min, antiwindup);
  EXPECT_THAT((std::vector<double>{p, i, d, i_max, i_min}),
              testing::ElementsAre(1.0, 2.0, 3.0, 4.0, -4.0));
  EXPECT_FALSE(antiwindup);
  held.setGains(5.0, 6.0, 7.0, 8.0, -9.0, true);
  held.getGains(p, i, d, i_max, i_min, antiwindup);
  EXPECT_THAT((std::vector<double>{p, i, d, i_max, i_min}),
              testing::ElementsAre(5.0, 6.0, 7.0, 8.0, -9.0));
  EXPECT_TRUE(antiwindup);
}

TEST_F(PidControllers, PublishesTheStateEveryTenthStep) {
  setGains("c/pid", 2.0);
  ASSERT_TRUE(load("effort_controllers/JointPositionController", "arm"));
  std::mutex mutex;
  std::vector<control_msgs::JointControllerState> states;
  const ros::Subscriber subscriber = nh_.subscribe<control_msgs::JointControllerState>(
      "c/state", 1000, [&](const control_msgs::JointControllerStateConstPtr& state) {
        const std::lock_guard<std::mutex> lock(mutex);
        states.push_back(*state);
      });
  ASSERT_TRUE(eventually([&] { return subscriber.getNumPublishers() > 0; }));
  start();
  controller<effort_controllers::JointPositionController>().setCommand(0.5);
  ASSERT_TRUE(stepsUntil([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return states.size() >= 5;
  }));
  const std::lock_guard<std::mutex> lock(mutex);
  const control_msgs::JointControllerState& state = states.back();
  EXPECT_EQ(0.5, state.set_point);
  EXPECT_EQ(0.3, state.process_value);
  EXPECT_NEAR(0.2, state.error, 1e-12);
  EXPECT_NEAR(0.4, state.command, 1e-12);
  EXPECT_EQ(2.0, state.p);
  EXPECT_NEAR(0.001, state.time_step, 1e-12);
  // A state may be dropped, but no extra one published.
  const double apart = (states[4].header.stamp - states[3].header.stamp).toSec() / 0.01;
  EXPECT_NEAR(std::round(apart), apart, 1e-6);
  EXPECT_GE(apart, 0.5);
}

TEST_F(PidControllers, ReportsMissingParameters) {
  LogCatcher log;
  EXPECT_FALSE(load("effort_controllers/JointPositionController", "arm"));
  EXPECT_THAT(log.text(), HasSubstr("No p gain specified for pid.  Namespace: "
                                    "/ReportsMissingParameters/c/pid"));
  ros::param::set("robot_description", R"(<robot name="armless"><link name="base"/></robot>)");
  setGains("c/pid", 1.0);
  EXPECT_FALSE(load("effort_controllers/JointPositionController", "arm"));
  EXPECT_THAT(log.text(), HasSubstr("Could not find joint 'arm' in urdf (robot 'armless')"));
  ros::param::del("robot_description");
  EXPECT_FALSE(load("velocity_controllers/JointPositionController", "arm"));
  EXPECT_THAT(log.text(), HasSubstr("robot_description"));
}
