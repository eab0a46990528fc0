// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Controllers that must not, or cannot, command the robot are not started.
#include <franka/control_tools.h>
#include <franka_hw/franka_combined_hw.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "support.h"

namespace franka_hw_test {
namespace {

void expectWords(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(std::string::npos, text.find(word)) << "'" << word << "' is not in:\n" << text;
  }
}

class Refusals : public testing::Test {
 protected:
  void SetUp() override {
    // The robot of this test has a loopback address, for which libfranka would not enforce it.
    ASSERT_EQ(0, setenv("FRANKA_REALTIME", "enforce", 1));
  }
  void TearDown() override { unsetenv("FRANKA_REALTIME"); }

  FakeArm arm_{"fr3"};
  franka_hw::FrankaHW robot_;
};

TEST_F(Refusals, AnFr3IsNotCommandedAsAPanda) {
  arm_.nh.setParam("robot_description", urdfOf("fr3", "panda"));
  const LogCatcher log;
  ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh));
  const std::string parameter = arm_.robot_nh.resolveName("ignore_robot_mismatch");
  expectWords(log.text(ros::console::levels::Warn), {"an FR3", "a Panda's", parameter});
  Loop loop(robot_, arm_);
  for (const std::string kind : {"JT", "JP", "JV", "CP", "CV"}) {
    EXPECT_FALSE(loop.switchTo({kind}, {})) << kind;
    EXPECT_FALSE(loop.controller(kind).isRunning());
    expectWords(log.text(ros::console::levels::Error),
                {"'" + kind + "' cannot command 'fr3'", "a Panda's", parameter});
  }
  EXPECT_TRUE(loop.switchTo({"looks"}, {})) << "a read-only controller is accepted";
  EXPECT_EQ(0, arm_.robot.count(Command::kMove));

  arm_.robot_nh.setParam("ignore_robot_mismatch", true);
  EXPECT_TRUE(loop.switchTo({"JT"}, {}));
  EXPECT_TRUE(eventually([&] { return arm_.robot.count(Command::kMove) == 1; }));
}

TEST_F(Refusals, JointsNamedAfterAnotherArmAreNotCommanded) {
  arm_.robot_nh.setParam("arm_id", "other");
  ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh));
  Loop loop(robot_, arm_);
  const LogCatcher log;
  EXPECT_FALSE(loop.switchTo({"JT"}, {})) << "it would run and command nothing";
  expectWords(log.text(ros::console::levels::Error), {"arm_id is 'other'", "fr3_joint1"});
}

// The robot's thread gets real-time priority where the kernel has real-time support.
using RefusalsOnWallClock = Refusals;

TEST_F(RefusalsOnWallClock, ControllersAreStartedWhereLibfrankaWouldMoveTheRobot) {
  arm_.robot_nh.setParam("realtime_config", "enforce");
  const LogCatcher log;
  ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh));
  bool possible = franka::hasRealtimeKernel();
  std::thread([&] {
    possible = possible && franka::setCurrentThreadToHighestSchedulerPriority(nullptr);
  }).join();
  const std::string sentence = "realtime_config:=ignore";
  EXPECT_EQ(possible, log.text(ros::console::levels::Warn).find(sentence) == std::string::npos);
  Loop loop(robot_, arm_);
  EXPECT_EQ(possible, loop.switchTo({"JT"}, {}));
  EXPECT_EQ(possible, loop.controller("JT").isRunning());
  EXPECT_EQ(possible, log.text(ros::console::levels::Error).find(sentence) == std::string::npos);
  EXPECT_TRUE(loop.errors().empty());
}

TEST_F(Refusals, OneArmOfSeveralIsRefusedByName) {
  const ros::NodeHandle nh = FakeArm::freshNamespace();
  FakeArm left("left", nh), right("right", nh);
  for (FakeArm* arm : {&left, &right}) {
    arm->robot_nh.setParam("type", "franka_hw/FrankaCombinableHW");
  }
  // One description for both; its joints are named after the left arm only.
  nh.setParam("robot_description", urdfOf("left"));
  nh.setParam("robot_hardware", std::vector<std::string>{"left", "right"});
  franka_hw::FrankaCombinedHW robots;
  ros::NodeHandle own = nh;
  ASSERT_TRUE(robots.init(own, own));
  const auto claiming = [](const std::string& arm_id) {
    hardware_interface::ControllerInfo info;
    info.name = arm_id + "_controller";
    const std::vector<std::string> joints = FakeArm::joints(arm_id);
    info.claimed_resources.emplace_back("hardware_interface::EffortJointInterface",
                                        std::set<std::string>(joints.begin(), joints.end()));
    return info;
  };
  const LogCatcher log;
  EXPECT_TRUE(robots.prepareSwitch({claiming("left")}, {}));
  EXPECT_TRUE(robots.prepareSwitch({}, {claiming("left")}));
  EXPECT_FALSE(robots.prepareSwitch({claiming("right")}, {}));
  expectWords(log.text(ros::console::levels::Error),
              {"'right_controller' cannot command 'right'", "it describes 'left'"});
}

}  // namespace
}  // namespace franka_hw_test
