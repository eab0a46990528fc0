// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <combined_robot_hw/combined_robot_hw.h>
#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "test_robot.h"

using combined_robot_hw_test::Robot;
using hardware_interface::EffortJointInterface;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

class Loaded : public combined_robot_hw::CombinedRobotHW {
 public:
  std::size_t members() const { return robot_hw_list_.size(); }
  Robot* member(std::size_t i) { return dynamic_cast<Robot*>(robot_hw_list_[i].get()); }
};

class Loading : public testing::Test {
 protected:
  Loading() {
    nh_.setParam("robot_hardware", std::vector<std::string>{"left", "right"});
    describe("left", {"l1", "l2"});
    describe("right", {"r1"});
  }
  ~Loading() override { root_.deleteParam("loading_test"); }

  void describe(const std::string& name, const std::vector<std::string>& joints,
                const std::string& type = "combined_robot_hw_test/Robot") {
    nh_.setParam(name + "/type", type);
    nh_.setParam(name + "/joints", joints);
  }

  /// Expects that init fails and registers nothing.
  void expectRefusal() {
    EXPECT_FALSE(combined_.init(root_, nh_));
    EXPECT_EQ(0u, combined_.members());
    EXPECT_THAT(combined_.getNames(), IsEmpty());
    EXPECT_EQ(nullptr, combined_.get<EffortJointInterface>());
  }

  ros::NodeHandle root_;
  ros::NodeHandle nh_{"loading_test"};
  Loaded combined_;
};

}  // namespace

TEST_F(Loading, CombinesTheRobotsNamedInOrder) {
  ASSERT_TRUE(combined_.init(root_, nh_));
  ASSERT_EQ(2u, combined_.members());
  ASSERT_NE(nullptr, combined_.member(0));
  EXPECT_EQ(root_.getNamespace(), combined_.member(0)->root_namespace);
  EffortJointInterface* efforts = combined_.get<EffortJointInterface>();
  ASSERT_NE(nullptr, efforts);
  EXPECT_THAT(efforts->getNames(), ElementsAre("l1", "l2", "r1"));
  efforts->getHandle("r1").setCommand(5.0);
  EXPECT_EQ(5.0, combined_.member(1)->command[0]);
}

TEST_F(Loading, ReadsAndWritesAllOfThem) {
  ASSERT_TRUE(combined_.init(root_, nh_));
  combined_.get<EffortJointInterface>()->getHandle("l1").setCommand(3.0);
  combined_.get<EffortJointInterface>()->getHandle("r1").setCommand(4.0);
  combined_.read(ros::Time(7.0), ros::Duration(0.002));
  combined_.write(ros::Time(7.0), ros::Duration(0.002));
  EXPECT_EQ(7.0, combined_.get<EffortJointInterface>()->getHandle("l2").getPosition());
  EXPECT_EQ(7.0, combined_.get<EffortJointInterface>()->getHandle("r1").getPosition());
  EXPECT_EQ(3.0, combined_.member(0)->written);
  EXPECT_EQ(4.0, combined_.member(1)->written);
  EXPECT_EQ(0.002, combined_.member(1)->write_period);
}

TEST_F(Loading, RequiresAListOfNames) {
  nh_.deleteParam("robot_hardware");
  expectRefusal();
  nh_.setParam("robot_hardware", "left");
  expectRefusal();
  nh_.setParam("robot_hardware", std::vector<int>{1, 2});
  expectRefusal();
  nh_.setParam("robot_hardware", std::vector<std::string>());
  expectRefusal();
  nh_.setParam("robot_hardware", std::vector<std::string>{"left", "left"});
  expectRefusal();
  nh_.setParam("robot_hardware", std::vector<std::string>{"left", "right hand"});
  expectRefusal();
}

TEST_F(Loading, RequiresAnExistingType) {
  nh_.deleteParam("right/type");
  expectRefusal();
  nh_.setParam("right/type", 5);
  expectRefusal();
  describe("right", {"r1"}, "combined_robot_hw_test/Unheard");
  expectRefusal();
  describe("right", {"r1"}, "combined_robot_hw_test/AbsentRobot");
  expectRefusal();
}

TEST_F(Loading, FailsIfOneRobotFails) {
  for (const char* way : {"false", "exception", "word"}) {
    nh_.setParam("right/fail", way);
    expectRefusal();
  }
}

TEST_F(Loading, CanBeTriedAgain) {
  nh_.setParam("right/fail", "false");
  expectRefusal();
  nh_.setParam("right/fail", "");
  ASSERT_TRUE(combined_.init(root_, nh_));
  EXPECT_THAT(combined_.get<EffortJointInterface>()->getNames(), ElementsAre("l1", "l2", "r1"));
}
