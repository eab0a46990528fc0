// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// A robot with a revolute arm (limits -1 to 2 rad), a continuous wheel and a slide (limits -0.5 to
// 0.5 m), its controller manager, and time that the test advances.

#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/ros.h>
#include <ros_test/controller_loop.h>
#include <ros_test/log_catcher.h>
#include <std_msgs/Float64.h>

#include <array>
#include <string>
#include <vector>

namespace three_joints {

using ros_test::eventually;
using ros_test::LogCatcher;
typedef std::vector<std::string> Names;

enum Joint { kArm, kWheel, kSlide };

class Robot : public hardware_interface::RobotHW {
 public:
  Robot() {
    const std::array<std::string, 3> names{"arm", "wheel", "slide"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      const hardware_interface::JointStateHandle state(names[i], &position_[i], &velocity_[i],
                                                       &effort_[i]);
      states_.registerHandle(state);
      positions_.registerHandle(hardware_interface::JointHandle(state, &position_command_[i]));
      velocities_.registerHandle(hardware_interface::JointHandle(state, &velocity_command_[i]));
      efforts_.registerHandle(hardware_interface::JointHandle(state, &effort_command_[i]));
    }
    registerInterface(&states_);
    registerInterface(&positions_);
    registerInterface(&velocities_);
    registerInterface(&efforts_);
  }

  /// The test writes what the robot measures.
  void move(double /*dt*/) {}

  std::array<double, 3> position_{{0.3, 0.2, 0.1}}, velocity_{}, effort_{};
  std::array<double, 3> position_command_{}, velocity_command_{}, effort_command_{};

 private:
  hardware_interface::JointStateInterface states_;
  hardware_interface::PositionJointInterface positions_;
  hardware_interface::VelocityJointInterface velocities_;
  hardware_interface::EffortJointInterface efforts_;
};

/// Each test has its own namespace, named after it.
class ControllerTest : public ros_test::ControllerLoop<Robot>, public testing::Test {
 protected:
  ControllerTest() : ControllerLoop(testing::UnitTest::GetInstance()->current_test_info()->name()) {
    nh_.deleteParam("c");  // for a master that outlives a run
    ros::param::set("robot_description", R"(
      <robot name="three_joints">
        <link name="base"/><link name="a"/><link name="b"/><link name="c"/>
        <joint name="arm" type="revolute">
          <parent link="base"/><child link="a"/>
          <limit lower="-1" upper="2" effort="1" velocity="1"/>
        </joint>
        <joint name="wheel" type="continuous"><parent link="a"/><child link="b"/></joint>
        <joint name="slide" type="prismatic">
          <parent link="b"/><child link="c"/>
          <limit lower="-0.5" upper="0.5" effort="1" velocity="1"/>
        </joint>
      </robot>)");
  }

  /// Loads the controller "c" for one joint.
  bool load(const std::string& type, const std::string& joint) {
    nh_.setParam("c/type", type);
    nh_.setParam("c/joint", joint);
    return manager_.loadController("c");
  }
  /// Loads the controller "c" for several joints.
  bool load(const std::string& type, const Names& joints) {
    nh_.setParam("c/type", type);
    nh_.setParam("c/joints", joints);
    return manager_.loadController("c");
  }
  static std_msgs::Float64 one(double value) {
    std_msgs::Float64 message;
    message.data = value;
    return message;
  }
  void setGains(const std::string& where, double p, double i = 0.0, double d = 0.0) {
    nh_.setParam(where + "/p", p);
    nh_.setParam(where + "/i", i);
    nh_.setParam(where + "/d", d);
  }

  void start() {
    ASSERT_TRUE(doSwitch({"c"}, {}));
    step();
  }
  void stop() {
    ASSERT_TRUE(doSwitch({}, {"c"}));
    step();
  }

  /// A connected publisher to the controller's topic `command`.
  template <class Message>
  ros::Publisher commander() {
    const ros::Publisher publisher = nh_.advertise<Message>("c/command", 1);
    EXPECT_TRUE(eventually([&] { return publisher.getNumSubscribers() > 0; }));
    return publisher;
  }
};

}  // namespace three_joints
