// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Thousands of switches, and controllers with faults.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <set>

#include "support.h"

namespace franka_hw_test {
namespace {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using Fault = TestController::Fault;

class Switching : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh));
    loop_.emplace(robot_, arm_);
  }

  /// Whether the robot follows the commands of this kind of controller.
  bool moves(const std::string& kind) const {
    const auto state = arm_.robot.state();
    const std::map<std::string, MotionGeneratorMode> generators{
        {"JT", MotionGeneratorMode::kNone},
        {"JP", MotionGeneratorMode::kJointPosition},
        {"JV", MotionGeneratorMode::kJointVelocity},
        {"CP", MotionGeneratorMode::kCartesianPosition},
        {"CV", MotionGeneratorMode::kCartesianVelocity}};
    return state.robot_mode == franka_core::RobotMode::kMove &&
           state.motion_generator_mode == generators.at(kind) &&
           (state.controller_mode == ControllerMode::kExternalController) == (kind == "JT");
  }

  void expectRuns(const std::string& claims) {
    TestController& controller = loop_->controller(claims);
    const int before = controller.updates;
    EXPECT_TRUE(eventually([&] { return controller.updates > before + 5; })) << claims;
    EXPECT_TRUE(moves(claims)) << claims;
  }

  FakeArm arm_{"fr3"};
  franka_hw::FrankaHW robot_;
  std::optional<Loop> loop_;
};

TEST_F(Switching, LosesNoControllerBetweenAllOrderedPairsOfKinds) {
  const int switches = std::getenv("FRANKA_TEST_LONG") != nullptr ? 10000 : 300;
  std::mt19937 random(12);
  std::vector<std::string> all;
  for (const std::string kind : {"JT", "JP", "JV", "CP", "CV"}) {
    for (const std::string& name : {kind, kind + ":2"}) {
      loop_->controller(name).speed = name == kind ? 0.0 : 0.05;  // half of them move
      all.push_back(name);
    }
  }
  std::string current = "JT";
  ASSERT_TRUE(loop_->switchTo({current}, {}));
  std::set<std::string> pairs;
  int failures = 0;
  for (int i = 0; i < switches && failures < 10; i++) {
    std::string next = current;
    while (next == current) {
      next = all[random() % all.size()];
    }
    pairs.insert(current.substr(0, 2) + next.substr(0, 2));
    TestController& from = loop_->controller(current);
    TestController& to = loop_->controller(next);
    const int starts = to.starts;
    const bool switched = loop_->switchTo({next}, {current});
    const bool runs =
        switched && eventually([&] { return to.updates_since_start > 2 && !from.isRunning(); });
    if (!runs || !to.isRunning() || !moves(next.substr(0, 2)) || to.starts < starts + 1) {
      failures++;
      ADD_FAILURE() << "switch " << i << " from " << current << " to " << next << ": "
                    << (switched ? "does not run" : "refused");
      for (const std::string& error : loop_->errors()) {
        ADD_FAILURE() << error;
      }
      loop_->forgetErrors();
    }
    current = next;
  }
  EXPECT_EQ(0, failures);
  EXPECT_EQ(25u, pairs.size()) << "all ordered pairs, same kinds included";
  EXPECT_TRUE(loop_->errors().empty());
}

TEST_F(Switching, OneCallMayStopAndStartTheSameController) {
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
  const int starts = loop_->controller("JP").starts;
  const int motions = arm_.robot.count(Command::kMove);
  ASSERT_TRUE(loop_->switchTo({"JP"}, {"JP"}));
  expectRuns("JP");
  EXPECT_EQ(motions + 1, arm_.robot.count(Command::kMove)) << "it starts at rest";
  EXPECT_EQ(starts + 1, loop_->controller("JP").starts);
  EXPECT_EQ(1, loop_->controller("JP").stops);
}

TEST_F(Switching, ReadOnlyControllerDoesNotDisturbAMotion) {
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
  const int moves_before = arm_.robot.count(Command::kMove);
  TestController& looker = loop_->controller("looks");  // claims nothing
  ASSERT_TRUE(loop_->switchTo({"looks"}, {}));
  EXPECT_TRUE(eventually([&] { return looker.updates > 5; }));
  expectRuns("JP");
  EXPECT_EQ(moves_before, arm_.robot.count(Command::kMove));
}

TEST_F(Switching, TorquesPassFromOneControllerToTheNextWithinAMotion) {
  ASSERT_TRUE(loop_->switchTo({"JT"}, {}));
  expectRuns("JT");
  const int moves_before = arm_.robot.count(Command::kMove);
  ASSERT_TRUE(loop_->switchTo({"JT:2"}, {"JT"}));
  ASSERT_TRUE(eventually([&] { return loop_->controller("JT:2").updates_since_start > 5; }));
  EXPECT_EQ(moves_before, arm_.robot.count(Command::kMove));

  // Another setting needs another motion. The node receives a parameter a little later.
  arm_.robot_nh.setParam("rate_limiting", true);
  std::pair<std::string, std::string> names{"JT:2", "JT"};
  EXPECT_TRUE(eventually([&] {
    EXPECT_TRUE(loop_->switchTo({names.second}, {names.first}));
    std::swap(names.first, names.second);
    return arm_.robot.count(Command::kMove) > moves_before;
  }));
}

TEST_F(Switching, RemainingControllerIsStartedAgainWithTheNewMotion) {
  ASSERT_TRUE(loop_->switchTo({"JT"}, {}));
  expectRuns("JT");
  const int starts = loop_->controller("JT").starts;
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));  // in addition to the torques
  ASSERT_TRUE(eventually([&] { return loop_->controller("JP").updates_since_start > 5; }));
  EXPECT_EQ(starts + 1, loop_->controller("JT").starts);
}

TEST_F(Switching, ASwitchThatNeverComesLeavesTheMotionAsItWas) {
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
  loop_->controller("JV");
  const std::list<hardware_interface::ControllerInfo> running{loop_->info("JP")};
  const std::list<hardware_interface::ControllerInfo> velocities{loop_->info("JV")};
  for (int times = 1; times <= 2; times++) {
    const int starts = loop_->controller("JP").starts;
    ASSERT_TRUE(robot_.prepareSwitch(velocities, running));
    EXPECT_FALSE(robot_.controllerActive());
    ASSERT_TRUE(robot_.prepareSwitch(running, velocities));
    expectRuns("JP");
    EXPECT_EQ(starts + 1, loop_->controller("JP").starts);
  }
  ASSERT_TRUE(loop_->switchTo({"JV"}, {"JP"}));
  expectRuns("JV");
}

TEST_F(Switching, ARefusedSwitchLeavesTheMotionAsItIs) {
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
  loop_->controller("JV");
  // The manager would not ask: it finds the conflict first.
  EXPECT_FALSE(robot_.prepareSwitch({loop_->info("JV")}, {}));
  EXPECT_TRUE(robot_.controllerActive());
  expectRuns("JP");
  EXPECT_EQ(1, loop_->controller("JP").starts);
  EXPECT_EQ(1, arm_.robot.count(Command::kMove));
}

TEST_F(Switching, WithdrawingTheFirstStartLeavesTheRobotAtRest) {
  loop_->controller("JP");
  const std::list<hardware_interface::ControllerInfo> positions{loop_->info("JP")};
  ASSERT_TRUE(robot_.prepareSwitch(positions, {}));
  ASSERT_TRUE(robot_.prepareSwitch({}, positions));
  EXPECT_FALSE(robot_.controllerActive());
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
}

// --- controllers that misbehave ------------------------------------------------------------------

TEST_F(Switching, AControllerThatThrowsEndsTheMotionWithItsMessage) {
  TestController& controller = loop_->controller("JP");
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
  controller.fault = Fault::kThrow;
  ASSERT_TRUE(eventually([&] { return !loop_->errors().empty(); }));
  controller.fault = Fault::kNone;
  EXPECT_EQ("this controller has had enough", loop_->errors()[0]);
  EXPECT_TRUE(
      eventually([&] { return arm_.robot.state().robot_mode == franka_core::RobotMode::kIdle; }));
  loop_->forgetErrors();
  expectRuns("JP");
}

TEST_F(Switching, NanReachesTheRobotInNoMode) {
  for (const std::string kind : {"JT", "JP", "JV", "CP", "CV"}) {
    TestController& controller = loop_->controller(kind);
    ASSERT_TRUE(loop_->switchTo({kind}, {}));
    expectRuns(kind);
    controller.fault = Fault::kNan;
    ASSERT_TRUE(eventually([&] { return !loop_->errors().empty(); })) << kind;
    controller.fault = Fault::kNone;
    EXPECT_NE(std::string::npos, loop_->errors()[0].find("fr3")) << loop_->errors()[0];
    EXPECT_NE(std::string::npos, loop_->errors()[0].find("NaN")) << loop_->errors()[0];
    for (const auto& exchange : arm_.robot.exchanges()) {
      const auto& command = exchange.command;
      for (double value : {command.tau_J_d[0], command.q_c[0], command.dq_c[0],
                           command.O_T_EE_c[12], command.O_dP_EE_c[2]}) {
        ASSERT_TRUE(std::isfinite(value)) << kind;
      }
    }
    loop_->forgetErrors();
    expectRuns(kind);
    ASSERT_TRUE(loop_->switchTo({}, {kind}));
  }
}

TEST_F(Switching, SlowControllerRunsWithoutAnError) {
  TestController& controller = loop_->controller("JT");
  controller.fault = Fault::kSleep;
  ASSERT_TRUE(loop_->switchTo({"JT"}, {}));
  ASSERT_TRUE(eventually([&] { return controller.updates_since_start > 50; }));
  EXPECT_TRUE(loop_->errors().empty());
  ASSERT_TRUE(loop_->switchTo({"JP"}, {"JT"}));
  expectRuns("JP");
}

TEST_F(Switching, AReflexIsReportedAndAfterItTheControllerGoesOn) {
  arm_.robot.script([](auto& script) {
    script.abort_after = 50;
    script.abort_errors = {6};
  });
  ASSERT_TRUE(loop_->switchTo({"JT"}, {}));
  ASSERT_TRUE(eventually([&] { return !loop_->errors().empty(); }));
  EXPECT_NE(std::string::npos, loop_->errors()[0].find("joint_reflex")) << loop_->errors()[0];
  EXPECT_TRUE(eventually([&] { return robot_.robotMode() == franka::RobotMode::kReflex; }));
  arm_.robot.script([](auto& script) { script.abort_after = -1; });
  {
    const std::lock_guard<std::mutex> lock(robot_.robotMutex());
    robot_.robot().automaticErrorRecovery();
  }
  arm_.robot.change([](auto& state) {
    state.robot_mode = franka_core::RobotMode::kIdle;
    state.errors = {};
  });
  loop_->forgetErrors();
  expectRuns("JT");
}

TEST_F(Switching, AStartInReflexIsAcceptedWithAWarning) {
  const LogCatcher log;
  const auto warns = [&log](const char* word) {
    return log.text(ros::console::levels::Warn).find(word) != std::string::npos;
  };
  ASSERT_TRUE(loop_->switchTo({"JP"}, {}));
  expectRuns("JP");
  EXPECT_FALSE(warns("error_recovery"));
  ASSERT_TRUE(loop_->switchTo({}, {"JP"}));
  arm_.robot.change([](auto& state) { state.robot_mode = franka_core::RobotMode::kReflex; });
  ASSERT_TRUE(eventually([&] { return robot_.robotMode() == franka::RobotMode::kReflex; }));
  ASSERT_TRUE(loop_->switchTo({"looks"}, {}));
  EXPECT_FALSE(warns("error_recovery")) << "a controller that only reads needs no recovery";
  EXPECT_TRUE(loop_->switchTo({"JT"}, {}));
  EXPECT_TRUE(warns("Reflex") && warns("error_recovery")) << log.text(ros::console::levels::Warn);
}

}  // namespace
}  // namespace franka_hw_test
