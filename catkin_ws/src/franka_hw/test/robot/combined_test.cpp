// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Several arms as one robot: FrankaCombinedHW and the FrankaCombinableHW that it loads.
#include <franka_hw/franka_combined_hw.h>
#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <limits>

#include "support.h"

namespace franka_hw_test {
namespace {

using hardware_interface::ControllerInfo;
using hardware_interface::EffortJointInterface;

const char* const kEffort = "hardware_interface::EffortJointInterface";

ControllerInfo claiming(const std::string& arm_id, const std::string& interface = kEffort) {
  ControllerInfo info;
  info.name = arm_id + "_controller";
  info.type = "test/Any";
  const std::vector<std::string> joints = FakeArm::joints(arm_id);
  info.claimed_resources.emplace_back(interface,
                                      std::set<std::string>(joints.begin(), joints.end()));
  return info;
}

class Combined : public testing::Test {
 protected:
  void SetUp() override {
    for (FakeArm* arm : {&left_, &right_}) {
      arm->robot_nh.setParam("type", "franka_hw/FrankaCombinableHW");
    }
    nh_.setParam("robot_hardware", std::vector<std::string>{"left", "right"});
    ASSERT_TRUE(robot_.init(nh_, nh_));
  }

  /// One turn of the controllers' loop, in which each arm is commanded a torque of its own.
  void cycle() {
    const ros::Time now = ros::Time::now();
    robot_.read(now, ros::Duration(0.001));
    needed_reset_ = needed_reset_ || robot_.controllerNeedsReset();
    command("left", 1.5);
    command("right", -2.5);
    robot_.write(now, ros::Duration(0.001));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  bool cycleUntil(const std::function<bool()>& condition) {
    return waitUntil([&] {
      cycle();
      return condition();
    });
  }
  void command(const std::string& arm_id, double torque) {
    for (const std::string& joint : FakeArm::joints(arm_id)) {
      robot_.get<EffortJointInterface>()->getHandle(joint).setCommand(torque);
    }
  }
  void start() {
    const std::list<ControllerInfo> both{claiming("left"), claiming("right")};
    ASSERT_FALSE(robot_.checkForConflict(both));
    ASSERT_TRUE(robot_.prepareSwitch(both, {}));
    robot_.doSwitch(both, {});
  }
  static double torqueOf(const FakeArm& arm) { return arm.robot.state().tau_J_d[3]; }

  ros::NodeHandle nh_{FakeArm::freshNamespace()};
  FakeArm left_{"left", nh_}, right_{"right", nh_};
  bool needed_reset_{false};
  franka_hw::FrankaCombinedHW robot_;
};

TEST_F(Combined, ShowsTheJointsOfAllArmsAndTakesTorquesOnly) {
  EXPECT_EQ(14u, robot_.get<hardware_interface::JointStateInterface>()->getNames().size());
  EXPECT_EQ(14u, robot_.get<EffortJointInterface>()->getNames().size());
  EXPECT_EQ(2u, robot_.get<franka_hw::FrankaStateInterface>()->getNames().size());
  EXPECT_EQ(2u, robot_.get<franka_hw::FrankaModelInterface>()->getNames().size());
  EXPECT_EQ(nullptr, robot_.get<hardware_interface::PositionJointInterface>());
}

TEST_F(Combined, RefusesWhatIsNoTorque) {
  FakeArm arm("alone");
  franka_hw::FrankaCombinableHW alone;
  ASSERT_TRUE(alone.init(arm.nh, arm.robot_nh));
  EXPECT_FALSE(alone.checkForConflict({claiming("alone")}));
  for (const char* interface : {"hardware_interface::PositionJointInterface",
                                "hardware_interface::VelocityJointInterface"}) {
    const LogCatcher log;
    EXPECT_TRUE(alone.checkForConflict({claiming("alone", interface)}));
    EXPECT_NE(std::string::npos, log.text().find("torques only"));
    EXPECT_FALSE(alone.prepareSwitch({claiming("alone", interface)}, {}));
    EXPECT_FALSE(alone.controllerActive());
  }
}

TEST_F(Combined, CommandsEachArmItsOwn) {
  start();
  EXPECT_TRUE(cycleUntil([&] { return torqueOf(left_) == 1.5 && torqueOf(right_) == -2.5; }));
  EXPECT_FALSE(robot_.hasError());
  EXPECT_FALSE(robot_.disconnect()) << "not while controllers run";
  const std::list<ControllerInfo> both{claiming("left"), claiming("right")};
  ASSERT_TRUE(robot_.prepareSwitch({}, both));
  robot_.doSwitch({}, both);
  EXPECT_TRUE(cycleUntil([&] {
    return left_.robot.state().robot_mode == franka_core::RobotMode::kIdle &&
           right_.robot.state().robot_mode == franka_core::RobotMode::kIdle;
  }));
}

TEST_F(Combined, AnErrorOfOneStopsAllUntilAllAreRecovered) {
  left_.robot.script([](auto& script) {
    script.abort_after = 50;
    script.abort_errors = {6};
  });
  start();
  ASSERT_TRUE(cycleUntil([&] { return robot_.hasError(); }));
  ASSERT_TRUE(
      cycleUntil([&] { return right_.robot.state().robot_mode == franka_core::RobotMode::kIdle; }));
  EXPECT_EQ(franka_core::RobotMode::kReflex, left_.robot.state().robot_mode);

  left_.robot.script([](auto& script) { script.abort_after = -1; });
  left_.robot.change([](auto& state) {
    state.robot_mode = franka_core::RobotMode::kIdle;
    state.errors = {};
  });
  const int moves = right_.robot.count(Command::kMove);
  // The action's goal, as its topic carries it.
  ros::Publisher goal =
      nh_.advertise<franka_msgs::ErrorRecoveryActionGoal>("error_recovery/goal", 1);
  ASSERT_TRUE(cycleUntil([&] { return goal.getNumSubscribers() > 0; }));
  goal.publish(franka_msgs::ErrorRecoveryActionGoal());
  EXPECT_TRUE(cycleUntil([&] { return torqueOf(left_) == 1.5 && torqueOf(right_) == -2.5; }));
  EXPECT_FALSE(robot_.hasError());
  EXPECT_TRUE(needed_reset_) << "the controllers were told to start anew";
  EXPECT_FALSE(robot_.controllerNeedsReset()) << "once";
  EXPECT_EQ(moves + 1, right_.robot.count(Command::kMove));
}

TEST_F(Combined, NanOnOneArmIsAnErrorAndReachesNoRobot) {
  start();
  ASSERT_TRUE(cycleUntil([&] { return torqueOf(left_) == 1.5; }));
  ASSERT_TRUE(waitUntil([&] {
    robot_.read(ros::Time::now(), ros::Duration(0.001));
    command("left", std::numeric_limits<double>::quiet_NaN());
    robot_.write(ros::Time::now(), ros::Duration(0.0));
    return robot_.hasError();
  }));
  for (const auto& exchange : left_.robot.exchanges()) {
    ASSERT_FALSE(std::isnan(exchange.command.tau_J_d[0]));
  }
}

TEST_F(Combined, ConnectionsAreGivenUpAndTakenTogether) {
  std_srvs::Trigger trigger;
  ASSERT_TRUE(ros::service::call(nh_.resolveName("disconnect"), trigger));
  EXPECT_TRUE(trigger.response.success) << trigger.response.message;
  ASSERT_TRUE(ros::service::call(nh_.resolveName("connect"), trigger));
  EXPECT_TRUE(trigger.response.success) << trigger.response.message;
  EXPECT_EQ(2, left_.robot.connections());
  EXPECT_EQ(2, right_.robot.connections());
  start();
  EXPECT_TRUE(cycleUntil([&] { return torqueOf(left_) == 1.5 && torqueOf(right_) == -2.5; }));
}

}  // namespace
}  // namespace franka_hw_test
