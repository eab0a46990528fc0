// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Several arms as one robot: FrankaCombinedHW and the FrankaCombinableHW that it loads.
#include <franka/extensions.h>
#include <franka_hw/arm_connection.h>
#include <franka_hw/franka_combined_hw.h>
#include <franka_msgs/SetLoad.h>
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

  /// One cycle of the controllers' loop, which commands a different torque to each arm.
  void cycle() {
    const ros::Time now = ros::Time::now();
    robot_.read(now, ros::Duration(0.001));
    resets_ += robot_.controllerNeedsReset() ? 1 : 0;
    command("left", 1.5);
    command("right", -2.5);
    robot_.write(now, ros::Duration(0.001));
  }
  bool cycleUntil(const std::function<bool()>& condition) {
    return eventually([&] {
      cycle();
      return condition();
    });
  }
  void command(const std::string& arm_id, double torque) {
    for (const std::string& joint : FakeArm::joints(arm_id)) {
      robot_.get<EffortJointInterface>()->getHandle(joint).setCommand(torque);
    }
  }
  void start(const std::list<ControllerInfo>& list = {claiming("left"), claiming("right")}) {
    ASSERT_FALSE(robot_.checkForConflict(list));
    ASSERT_TRUE(robot_.prepareSwitch(list, {}));
    robot_.doSwitch(list, {});
  }
  void stop(const std::list<ControllerInfo>& list = {claiming("left"), claiming("right")}) {
    ASSERT_TRUE(robot_.prepareSwitch({}, list));
    robot_.doSwitch({}, list);
  }
  /// Runs until both robots have sent so many states more, each of which the handles show in turn.
  bool statesGoOn(std::uint64_t states = 20) {
    bool all = true;
    for (const char* arm : {"left_robot", "right_robot"}) {
      const franka_hw::FrankaStateHandle handle =
          robot_.get<franka_hw::FrankaStateInterface>()->getHandle(arm);
      const franka::RobotState& state = handle.getRobotState();
      const std::uint64_t end = state.time.toMSec() + states;
      all = cycleUntil([&] { return state.time.toMSec() >= end; }) && all;
    }
    return all;
  }
  static double torqueOf(const FakeArm& arm) { return arm.robot.state().tau_J_d[3]; }
  bool bothMove() {
    return cycleUntil([&] { return torqueOf(left_) == 1.5 && torqueOf(right_) == -2.5; });
  }

  /// Calls one of the node's services: of an arm, or of all.
  std_srvs::Trigger::Response call(const std::string& service) {
    std_srvs::Trigger trigger;
    EXPECT_TRUE(ros::service::call(nh_.resolveName(service), trigger)) << service;
    return trigger.response;
  }
  /// Recovers all arms: publishes the action's goal on its topic.
  void recover() {
    ros::Publisher goal =
        nh_.advertise<franka_msgs::ErrorRecoveryActionGoal>("error_recovery/goal", 1);
    ASSERT_TRUE(cycleUntil([&] { return goal.getNumSubscribers() > 0; }));
    goal.publish(franka_msgs::ErrorRecoveryActionGoal());
    ASSERT_TRUE(cycleUntil([&] { return !robot_.hasError(); }));
  }

  ros::NodeHandle nh_{FakeArm::freshNamespace()};
  FakeArm left_{"left", nh_}, right_{"right", nh_};
  int resets_{0};
  franka_hw::FrankaCombinedHW robot_;
};

TEST_F(Combined, ShowsTheJointsOfAllArmsAndTakesTorquesOnly) {
  EXPECT_EQ(14u, robot_.get<hardware_interface::JointStateInterface>()->getNames().size());
  EXPECT_EQ(14u, robot_.get<EffortJointInterface>()->getNames().size());
  EXPECT_EQ(2u, robot_.get<franka_hw::FrankaStateInterface>()->getNames().size());
  EXPECT_EQ(2u, robot_.get<franka_hw::FrankaModelInterface>()->getNames().size());
  EXPECT_EQ(nullptr, robot_.get<hardware_interface::PositionJointInterface>());
}

TEST_F(Combined, RefusesTorquesThatAreNotNumbers) {
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

TEST_F(Combined, AcceptsASwitchBeforeItHasARobot) {
  FakeArm arm("alone");
  franka_hw::FrankaCombinableHW alone;
  ASSERT_TRUE(alone.initParameters(arm.nh, arm.robot_nh));
  alone.initROSInterfaces(arm.robot_nh);
  alone.setupParameterCallbacks(arm.robot_nh);
  EXPECT_TRUE(alone.prepareSwitch({claiming("alone")}, {}));
  EXPECT_FALSE(alone.controllerActive()) << "before doSwitch()";
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
  recover();
  EXPECT_TRUE(bothMove());
  EXPECT_FALSE(robot_.hasError());
  EXPECT_EQ(1, resets_);
  EXPECT_EQ(moves + 1, right_.robot.count(Command::kMove));
}

TEST_F(Combined, ArmsThatRecoverOneAfterAnotherResetTheControllersOnce) {
  start();
  int recoveries = 0;
  for (const std::size_t first : {0, 1}) {
    SCOPED_TRACE(first);
    ASSERT_TRUE(bothMove());
    franka_hw::FrankaCombinableHW* const arm = robot_.arms()[first];
    franka_hw::FrankaCombinableHW* const other = robot_.arms()[1 - first];
    const int moves = left_.robot.count(Command::kMove) + right_.robot.count(Command::kMove);
    arm->triggerError();
    ASSERT_TRUE(statesGoOn());
    other->triggerError();  // while it waits for the first one
    ASSERT_TRUE(statesGoOn());
    EXPECT_EQ(recoveries, resets_) << "nothing is recovered yet";
    arm->resetError();
    ASSERT_TRUE(statesGoOn());
    EXPECT_TRUE(arm->hasError()) << "it waits for the other one";
    EXPECT_EQ(recoveries, resets_);
    EXPECT_EQ(moves, left_.robot.count(Command::kMove) + right_.robot.count(Command::kMove));
    other->resetError();
    ASSERT_TRUE(bothMove());
    ASSERT_TRUE(statesGoOn());
    EXPECT_EQ(++recoveries, resets_);
  }
}

TEST_F(Combined, SwitchesOfOneArmLeaveTheMotionOfTheOther) {
  const std::list<ControllerInfo> left{claiming("left")}, right{claiming("right")};
  start(left);
  ASSERT_TRUE(cycleUntil([&] { return torqueOf(left_) == 1.5; }));
  const auto expectUndisturbed = [&](const char* what) {
    SCOPED_TRACE(what);
    EXPECT_TRUE(statesGoOn());
    EXPECT_TRUE(robot_.arms()[0]->controllerActive());
    EXPECT_EQ(1, left_.robot.count(Command::kMove));
    EXPECT_EQ(1.5, torqueOf(left_));
    EXPECT_EQ(0, resets_);
  };
  start(right);
  expectUndisturbed("started");
  ASSERT_TRUE(robot_.prepareSwitch(right, right));
  robot_.doSwitch(right, right);
  expectUndisturbed("restarted");
  stop(right);
  expectUndisturbed("stopped");
  EXPECT_FALSE(robot_.disconnect());
  EXPECT_TRUE(robot_.arms()[1]->connected()) << "the idle one, too";

  ASSERT_TRUE(call("right/disconnect").success);
  EXPECT_FALSE(robot_.prepareSwitch(right, left)) << "there is no right arm";
  EXPECT_TRUE(robot_.arms()[0]->controllerActive());
  EXPECT_TRUE(cycleUntil([&, end = left_.robot.state().message_id + 20] {
    return left_.robot.state().message_id > end;
  }));
  EXPECT_EQ(1, left_.robot.count(Command::kMove));
  EXPECT_EQ(0, resets_);
}

TEST_F(Combined, TorquesOfTheLastMotionAreNotSentInTheNext) {
  start();
  ASSERT_TRUE(bothMove());
  const int moves = left_.robot.count(Command::kMove);
  robot_.read(ros::Time::now(), ros::Duration(0.001));
  command("left", 1.5);
  robot_.triggerError();
  for (franka_hw::FrankaCombinableHW* const arm : robot_.arms()) {
    arm->resetError();
  }
  const auto answers = [&] {
    return left_.robot.count(Command::kMove) > moves ? left_.robot.exchanges().size() : 0;
  };
  ASSERT_TRUE(eventually([&] { return answers() > 10; }));
  robot_.write(ros::Time::now(), ros::Duration(0.001));  // of a state of the last motion
  const std::size_t before = answers();
  ASSERT_TRUE(eventually([&] { return answers() > before + 10; }));
  for (const auto& exchange : left_.robot.exchanges()) {
    ASSERT_EQ(0.0, exchange.command.tau_J_d[3]);
  }
  EXPECT_TRUE(bothMove()) << "with torques that the controllers computed since";
}

TEST_F(Combined, AStalledLoopDoesNotGoOnCommandingItsLastTorques) {
  for (FakeArm* arm : {&left_, &right_}) {
    arm->robot.script([](auto& script) { script.answer_timeout = std::chrono::milliseconds(2); });
  }
  start();
  ASSERT_TRUE(bothMove());
  const std::size_t before = left_.robot.exchanges().size();
  const std::uint64_t state = left_.robot.state().message_id;
  ASSERT_TRUE(eventually([&] { return left_.robot.state().message_id > state + 50; }));
  EXPECT_LE(left_.robot.exchanges().size(), before + 22);
  EXPECT_EQ(1.5, torqueOf(left_)) << "a robot decides by itself when it ends the motion";
  ASSERT_TRUE(cycleUntil([&] { return left_.robot.exchanges().size() > before + 100; }));
  stop();
}

TEST_F(Combined, NanOnOneArmIsAnErrorAndReachesNoRobot) {
  start();
  ASSERT_TRUE(cycleUntil([&] { return torqueOf(left_) == 1.5; }));
  ASSERT_TRUE(eventually([&] {
    robot_.read(ros::Time::now(), ros::Duration(0.001));
    command("left", std::numeric_limits<double>::quiet_NaN());
    robot_.write(ros::Time::now(), ros::Duration(0.0));
    return robot_.hasError();
  }));
  for (const auto& exchange : left_.robot.exchanges()) {
    ASSERT_FALSE(std::isnan(exchange.command.tau_J_d[0]));
  }
}

TEST_F(Combined, ConnectionsAreClosedAndOpenedTogether) {
  EXPECT_TRUE(call("disconnect").success);
  EXPECT_TRUE(call("connect").success);
  EXPECT_EQ(2, left_.robot.connections());
  EXPECT_EQ(2, right_.robot.connections());
  start();
  EXPECT_TRUE(bothMove());
}

// --- an arm that is lost -------------------------------------------------------------------------

class Losing : public Combined {
 protected:
  void SetUp() override {
    franka::Timeouts timeouts = usual_;
    timeouts.state = std::chrono::seconds(3);
    franka::setTimeouts(timeouts);
    Combined::SetUp();
  }
  void TearDown() override { franka::setTimeouts(usual_); }

  /// Removes the left robot during a motion of both.
  void loseLeft(bool stays_away = true) {
    left_.robot.script([=](auto& script) {
      script.close_after = 50;
      if (stays_away) {
        script.fatal.insert(Command::kConnect);
      }
    });
    start();
    ASSERT_TRUE(cycleUntil([&] { return !robot_.arms()[0]->connected(); }));
    ASSERT_TRUE(cycleUntil(
        [&] { return right_.robot.state().robot_mode == franka_core::RobotMode::kIdle; }));
  }
  void leftComesBack() {
    left_.robot.script([](auto& script) {
      script.close_after = -1;
      script.fatal.clear();
    });
  }

  const franka::Timeouts usual_{franka::timeouts()};
};

TEST_F(Losing, LostArmIsNamedAndOtherStaysAvailable) {
  const LogCatcher log;
  loseLeft();
  EXPECT_NE(std::string::npos, log.text().find("left: the robot is lost. ")) << log.text();
  EXPECT_NE(std::string::npos, log.text().find("Call the service connect when it is back."));
  EXPECT_TRUE(robot_.arms()[0]->armConnection().hasOwnError());
  EXPECT_FALSE(robot_.arms()[1]->armConnection().hasOwnError());

  const franka_hw::FrankaStateHandle handle =
      robot_.get<franka_hw::FrankaStateInterface>()->getHandle("right_robot");
  const franka::RobotState& right = handle.getRobotState();
  const std::uint64_t time = right.time.toMSec();
  EXPECT_TRUE(cycleUntil([&] { return right.time.toMSec() > time + 20; })) << "states go on";
  const std::string gone = left_.robot_nh.resolveName("set_load");
  EXPECT_TRUE(cycleUntil([&] { return !ros::service::exists(gone, false); }));
  franka_msgs::SetLoad load;
  ASSERT_TRUE(ros::service::call(right_.robot_nh.resolveName("set_load"), load));
  EXPECT_TRUE(load.response.success) << load.response.error;
  EXPECT_EQ(1, right_.robot.count(Command::kSetLoad));
}

TEST_F(Losing, ConnectReportsEachArm) {
  loseLeft();
  const std_srvs::Trigger::Response all = call("connect");
  EXPECT_FALSE(all.success);
  EXPECT_EQ(0u, all.message.find("FrankaCombinedHW: Failed to connect robot: 'left': libfranka"))
      << all.message;
  EXPECT_NE(std::string::npos, all.message.find("'right' is connected.")) << all.message;
  EXPECT_FALSE(call("left/connect").success);
  const std_srvs::Trigger::Response right = call("right/connect");
  EXPECT_FALSE(right.success);
  EXPECT_EQ("Already connected to robot. Cannot connect twice.", right.message);

  leftComesBack();
  EXPECT_TRUE(call("left/connect").success);
  EXPECT_TRUE(robot_.hasError()) << "it moves again only after a recovery";
  recover();
  EXPECT_TRUE(bothMove());
  EXPECT_EQ(1, resets_);
}

TEST_F(Losing, TheOtherGoesOnAloneWhenOneIsGivenUp) {
  loseLeft();
  const std_srvs::Trigger::Response early = call("left/disconnect");
  EXPECT_FALSE(early.success);
  EXPECT_NE(std::string::npos, early.message.find("'left'")) << early.message;
  stop();
  ASSERT_TRUE(robot_.hasError());
  EXPECT_TRUE(call("left/disconnect").success);
  ASSERT_TRUE(cycleUntil([&] { return !robot_.hasError(); }));
  recover();  // succeeds: an arm that was given up has nothing to recover

  const LogCatcher log;
  EXPECT_FALSE(robot_.prepareSwitch({claiming("left")}, {}));
  EXPECT_NE(std::string::npos, log.text().find("'left', which is not connected")) << log.text();
  ASSERT_TRUE(robot_.prepareSwitch({claiming("right")}, {}));
  robot_.doSwitch({claiming("right")}, {});
  EXPECT_TRUE(cycleUntil([&] { return torqueOf(right_) == -2.5; }));

  leftComesBack();
  EXPECT_TRUE(call("left/connect").success) << "while the other one moves";
  ASSERT_TRUE(robot_.prepareSwitch({claiming("left")}, {}));
  robot_.doSwitch({claiming("left")}, {});
  EXPECT_TRUE(bothMove());
}

class Reconnecting : public Losing {
 protected:
  void SetUp() override {
    nh_.setParam("reconnect", true);  // a parameter of the node: for all of its arms
    Losing::SetUp();
  }
};

TEST_F(Reconnecting, ALostArmComesBackByItselfButDoesNotMove) {
  const LogCatcher log;
  loseLeft();
  EXPECT_NE(std::string::npos, log.text().find("Trying to connect again")) << log.text();
  leftComesBack();
  ASSERT_TRUE(cycleUntil([&] { return robot_.arms()[0]->connected(); }));
  const std::uint64_t now = left_.robot.state().message_id;
  ASSERT_TRUE(cycleUntil([&] { return left_.robot.state().message_id > now + 100; }));
  EXPECT_TRUE(robot_.hasError());
  EXPECT_EQ(1, left_.robot.count(Command::kMove));
  recover();
  EXPECT_TRUE(bothMove());
}

TEST_F(Reconnecting, AnArmThatWasGivenUpStaysAway) {
  ASSERT_TRUE(call("left/disconnect").success);
  // The right one, which is lost later, has come back.
  right_.robot.script([](auto& script) { script.fatal = {Command::kSetLoad}; });
  franka_msgs::SetLoad load;
  ros::service::call(right_.robot_nh.resolveName("set_load"), load);
  EXPECT_FALSE(load.response.success);
  ASSERT_TRUE(cycleUntil([&] { return right_.robot.connections() == 2; }));
  EXPECT_FALSE(robot_.arms()[0]->connected());
  EXPECT_EQ(1, left_.robot.connections());
}

// --- what is measured ----------------------------------------------------------------------------

TEST_F(Combined, ResponseTimesCountFromTheStateThatTheControllersSaw) {
  start();
  ASSERT_TRUE(bothMove());
  constexpr std::chrono::milliseconds kWork{5};
  const auto slowCycle = [&] {
    robot_.read(ros::Time::now(), ros::Duration(0.001));
    std::this_thread::sleep_for(kWork);  // the fault itself
    robot_.write(ros::Time::now(), ros::Duration(0.001));
  };
  slowCycle();
  slowCycle();
  robot_.arms()[0]->responseTimes().take();
  for (int i = 0; i < 40; i++) {
    slowCycle();
  }
  const auto report = robot_.arms()[0]->responseTimes().take();
  EXPECT_GT(report.cycles, 40u) << "the robot is answered at its own pace";
  EXPECT_GT(report.mean, 5e-3);
  EXPECT_GE(report.longest, report.mean);
}

}  // namespace
}  // namespace franka_hw_test
