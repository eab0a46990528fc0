// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/switch_handover.h>

#include "manager_fixture.h"

using dummies::kBestEffort;
using dummies::kStrict;
using dummies::LogCatcher;
using hardware_interface::RobotHW;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

class SwitchTest : public dummies::ManagerTest {
 protected:
  void SetUp() override { load({"a", "b", "c", "d"}); }

  /// The script of a slow robot.
  static std::vector<RobotHW::SwitchState> ongoing(std::size_t answers) {
    return std::vector<RobotHW::SwitchState>(answers, RobotHW::SwitchState::ONGOING);
  }
};

}  // namespace

TEST_F(SwitchTest, StartsInOneCycleAndUpdatesFromTheNext) {
  const auto answer = beginSwitch({"a"}, {});
  EXPECT_TRUE(controller("a").isRunning());
  EXPECT_EQ(1, controller("a").starts_);
  EXPECT_EQ(0, controller("a").updates_);
  step();
  EXPECT_EQ(1, controller("a").updates_);
}

TEST_F(SwitchTest, UpdatesOnceMoreInTheCycleThatStops) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  int before = 0;
  const auto answer = beginSwitch({}, {"a"}, kStrict, false, 0.0, &controller("a"), &before);
  EXPECT_TRUE(controller("a").isStopped());
  EXPECT_EQ(before + 1, controller("a").updates_);
  step();
  EXPECT_EQ(before + 1, controller("a").updates_);
}

TEST_F(SwitchTest, PassesStartedAndStoppedControllersToTheRobot) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  ASSERT_TRUE(doSwitch({"b", "c"}, {"a"}));
  EXPECT_THAT(robot_.prepared_start_, ElementsAre("a", "b c"));
  EXPECT_THAT(robot_.prepared_stop_, ElementsAre("", "a"));
  EXPECT_EQ(2, robot_.switches_);
  EXPECT_EQ(2, robot_.started_);
  EXPECT_EQ(1, robot_.stopped_);
}

TEST_F(SwitchTest, CallsTheRobotForAnEmptySwitchToo) {
  EXPECT_TRUE(doSwitch({}, {}));
  EXPECT_THAT(robot_.prepared_start_, ElementsAre(""));
  EXPECT_EQ(1, robot_.switches_);
}

TEST(SwitchHandover, EndOfASwitchIsAwaited) {
  controller_manager::internal::LoopGate gate;
  controller_manager::internal::SwitchHandover handover(gate);
  std::atomic<bool> begun{false};
  std::atomic<bool> ended{false};
  std::future<bool> waiting;
  {
    const controller_manager::internal::SwitchHandover::Turn turn(handover, 0.0);
    ASSERT_TRUE(turn);
    handover.awaitEnd(std::chrono::seconds(0));  // it has been under way for longer
    waiting = std::async(std::launch::async, [&] {
      begun = true;
      handover.awaitEnd(std::chrono::hours(1));
      return ended.load();
    });
    while (!begun) {
      std::this_thread::yield();
    }
    ended = true;
  }
  EXPECT_TRUE(waiting.get());
}

TEST_F(SwitchTest, StrictRefusesAnyError) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  LogCatcher log;
  EXPECT_FALSE(doSwitch({"z"}, {}));
  EXPECT_FALSE(doSwitch({}, {"y"}));
  EXPECT_FALSE(doSwitch({}, {"c"}));
  EXPECT_FALSE(doSwitch({"a"}, {}));
  EXPECT_FALSE(doSwitch({"c"}, {"c"})) << "a restart needs something that runs";
  for (const char* const text : {"start controller with name 'z'", "stop controller with name 'y'",
                                 "'c' since it is not running", "'a' is already running"}) {
    EXPECT_THAT(log.text(), HasSubstr(text));
  }
  EXPECT_EQ(1, robot_.switches_);
}

TEST_F(SwitchTest, BestEffortIgnoresErrors) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  EXPECT_TRUE(doSwitch({"z", "c", "a"}, {"y", "d"}, kBestEffort));
  EXPECT_TRUE(controller("c").isRunning());
  EXPECT_TRUE(controller("a").isRunning());
  EXPECT_EQ(1, controller("a").starts_) << "what runs is not started again";
  EXPECT_TRUE(controller("d").isInitialized());
}

TEST_F(SwitchTest, UnknownStrictnessIsBestEffortWithAWarning) {
  LogCatcher log;
  EXPECT_TRUE(doSwitch({"z", "c"}, {}, 0));
  EXPECT_TRUE(controller("c").isRunning());
  EXPECT_THAT(log.text(), HasSubstr("strictness"));
}

TEST_F(SwitchTest, DuplicateNamesCountOnce) {
  EXPECT_TRUE(doSwitch({"a", "a"}, {}));
  EXPECT_EQ(1, controller("a").starts_);
  EXPECT_TRUE(doSwitch({}, {"a", "a"}));
  EXPECT_EQ(1, controller("a").stops_);
}

TEST_F(SwitchTest, StopAndStartOfARunningControllerIsARestart) {
  for (const int strictness : {kStrict, kBestEffort}) {
    doSwitch({"a"}, {}, kBestEffort);
    const int starts = controller("a").starts_;
    const int stops = controller("a").stops_;
    EXPECT_TRUE(doSwitch({"a"}, {"a"}, strictness));
    EXPECT_TRUE(controller("a").isRunning());
    EXPECT_EQ(starts + 1, controller("a").starts_);
    EXPECT_EQ(stops + 1, controller("a").stops_);
    EXPECT_EQ("a", robot_.prepared_start_.back()) << "the robot is told";
    EXPECT_EQ("a", robot_.prepared_stop_.back());
  }
}

TEST_F(SwitchTest, RefusesConflicts) {
  LogCatcher log;
  EXPECT_FALSE(doSwitch({"a", "b"}, {}));
  EXPECT_FALSE(doSwitch({"a", "b"}, {}, kBestEffort));
  ASSERT_TRUE(doSwitch({"a"}, {}));
  EXPECT_FALSE(doSwitch({"b"}, {}));
  EXPECT_TRUE(doSwitch({"b"}, {"a"})) << "stopped controllers do not count";
  EXPECT_THAT(log.text(), HasSubstr("Resource conflict on [j0].  Controllers = [a, b, ]"));
}

TEST_F(SwitchTest, RefusesASwitchThatTheRobotRefuses) {
  robot_.feasible_ = false;
  LogCatcher log;
  EXPECT_FALSE(doSwitch({"a"}, {}));
  EXPECT_THAT(log.text(), HasSubstr("unfeasible"));
  EXPECT_EQ(0, robot_.switches_);
}

TEST_F(SwitchTest, WaitsForTheRobotWithTwoCallsPerCycle) {
  robot_.script_ = ongoing(10);
  EXPECT_TRUE(doSwitch({"a"}, {}));
  EXPECT_EQ(11, robot_.result_calls_);
  EXPECT_EQ(5, controller("a").waits_);
  EXPECT_EQ(1, controller("a").starts_);
  EXPECT_EQ(1, robot_.switches_);
}

TEST_F(SwitchTest, StartsEachWhenTheRobotIsReadyForIt) {
  using State = RobotHW::SwitchState;
  // First cycle: a waits, c starts. Second: a waits. Third: a starts.
  robot_.script_ = {State::ONGOING, State::ONGOING, State::DONE,
                    State::ONGOING, State::ONGOING, State::DONE};
  const auto answer = beginSwitch({"a", "c"}, {}, kStrict, true);
  EXPECT_TRUE(controller("a").isWaiting());
  EXPECT_TRUE(controller("c").isRunning());
  step();
  step();
  EXPECT_TRUE(controller("a").isRunning());
  EXPECT_EQ(6, robot_.result_calls_);
  EXPECT_EQ(2, controller("a").waits_);
  EXPECT_EQ(0, controller("c").waits_);
  EXPECT_EQ(1, controller("c").starts_);
}

TEST_F(SwitchTest, RestartsOnceWhileOthersWait) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  using State = RobotHW::SwitchState;
  robot_.result_calls_ = 0;
  robot_.script_ = {State::DONE, State::ONGOING, State::ONGOING, State::ONGOING, State::ONGOING};
  EXPECT_TRUE(doSwitch({"a", "c"}, {"a"}, kStrict, true));
  EXPECT_EQ(2, controller("a").starts_);
  EXPECT_EQ(1, controller("a").stops_);
  EXPECT_EQ(2, controller("c").waits_);
}

TEST_F(SwitchTest, RobotErrorAbortsAndReturnsTrue) {
  robot_.after_script_ = RobotHW::SwitchState::ERROR;
  LogCatcher log;
  EXPECT_TRUE(doSwitch({"a", "c"}, {}));
  EXPECT_EQ(2, robot_.result_calls_);
  EXPECT_TRUE(controller("a").isAborted());
  EXPECT_TRUE(controller("c").isAborted());
  EXPECT_EQ(0, controller("a").waits_);
  EXPECT_THAT(log.text(), HasSubstr("Controller 'a' was not started"));
  robot_.after_script_ = RobotHW::SwitchState::DONE;
  EXPECT_TRUE(doSwitch({"a"}, {})) << "an aborted controller can be started later";
  EXPECT_TRUE(controller("a").isRunning());
  EXPECT_TRUE(manager_->unloadController("c"));
}

TEST_F(SwitchTest, RobotErrorAbortsOneOfSeveral) {
  using State = RobotHW::SwitchState;
  robot_.script_ = {State::ERROR, State::ERROR, State::ONGOING, State::ONGOING};
  EXPECT_TRUE(doSwitch({"a", "c"}, {}, kStrict, true));
  EXPECT_TRUE(controller("a").isAborted());
  EXPECT_TRUE(controller("c").isRunning());
  EXPECT_EQ(1, controller("a").aborts_);
  EXPECT_EQ(5, robot_.result_calls_);
}

TEST_F(SwitchTest, TimeoutUsesTheClockOfTheLoop) {
  for (const bool asap : {false, true}) {
    robot_.after_script_ = RobotHW::SwitchState::ONGOING;
    const int waits_before = controller("a").waits_;
    LogCatcher log;
    auto answer = beginSwitch({"a"}, {}, kStrict, asap, 50.5);
    for (int i = 0; i < 50; ++i) {
      time_ += ros::Duration(0.999);
      step();
      EXPECT_TRUE(controller("a").isWaiting());
    }
    time_ += ros::Duration(0.999);
    step();
    EXPECT_TRUE(controller("a").isAborted());
    EXPECT_EQ(waits_before + 51, controller("a").waits_);
    EXPECT_TRUE(answer.get());
    EXPECT_THAT(
        log.text(),
        HasSubstr("'a' was not started, because the robot was not ready for it after 50.5 s"));
  }
  EXPECT_EQ(2, controller("a").aborts_);
}

TEST_F(SwitchTest, ResetRestartsRunningControllers) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  const int updates = controller("a").updates_;
  step(true);
  EXPECT_EQ(1, controller("a").stops_);
  EXPECT_EQ(2, controller("a").starts_);
  EXPECT_EQ(updates, controller("a").updates_at_start_) << "restarted before the update";
  EXPECT_EQ(updates + 1, controller("a").updates_);
  EXPECT_EQ(0, controller("c").starts_);
}
