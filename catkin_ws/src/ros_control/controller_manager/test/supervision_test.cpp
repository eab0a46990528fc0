// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// What parameters turn on: faulty controllers are aborted alone, statistics, the default timeout.
#include <controller_manager/internal/time_statistics.h>
#include <controller_manager_msgs/ControllersStatistics.h>
#include <ros/callback_queue.h>

#include "supervision_fixture.h"

using dummies::FaultyController;
using dummies::kStrict;
using dummies::LogCatcher;
using dummies::Mischief;
using dummies::SupervisionTest;

TEST_F(SupervisionTest, withoutTheParameterExceptionsPassAsInTheOriginal) {
  renew();
  load({"faulty"});
  ASSERT_TRUE(doSwitch({"faulty"}, {}));
  FaultyController::inUpdate() = Mischief::kThrow;
  EXPECT_THROW(step(), std::runtime_error);
}

TEST_F(SupervisionTest, aControllerThatThrowsIsAbortedAlone) {
  renewGuarded();
  LogCatcher log;
  misbehave(Mischief::kThrow);
  EXPECT_THAT(log.text(), testing::HasSubstr("Controller 'faulty' was aborted, because its update "
                                             "threw: the matrix is singular."));
  EXPECT_EQ(7.0, command("j3"));
}

TEST_F(SupervisionTest, whateverItThrows) {
  renewGuarded();
  LogCatcher log;
  misbehave(Mischief::kThrowNumber);
  EXPECT_THAT(log.text(), testing::HasSubstr("threw: an exception of unknown type"));
}

TEST_F(SupervisionTest, noNanReachesTheRobot) {
  renewGuarded();
  LogCatcher log;
  misbehave(Mischief::kNan);
  EXPECT_THAT(log.text(), testing::HasSubstr("it commanded joint 'j3' a value that is no number"));
  EXPECT_EQ(7.0, command("j3"));
}

TEST_F(SupervisionTest, aSlowControllerIsAborted) {
  own_.setParam("max_update_time", 0.002);
  renewGuarded();
  LogCatcher log;
  misbehave(Mischief::kSlow);
  EXPECT_THAT(log.text(), testing::HasSubstr("max_update_time allows 2.000"));
}

TEST_F(SupervisionTest, anAbortedControllerCanBeStartedAgainAndFailAgain) {
  renewGuarded();
  for (int i = 1; i <= 3; ++i) {
    const int switches = robot_.switches_;
    FaultyController::inUpdate() = Mischief::kThrow;
    step();
    stepUntilTold(switches);
    FaultyController::inUpdate() = Mischief::kNone;
    ASSERT_TRUE(doSwitch({"faulty"}, {}));
    EXPECT_TRUE(controller("faulty").isRunning());
    EXPECT_EQ(i, controller("faulty").aborts_);
  }
}

TEST_F(SupervisionTest, theFallbackTakesOver) {
  nh_.setParam("faulty/fallback_controllers", Names{"c", "absent"});
  renewGuarded();
  load({"c"});
  LogCatcher log;
  misbehave(Mischief::kThrow);
  EXPECT_EQ("c", robot_.prepared_start_.back());
  waitFor([&] {
    step();
    return controller("c").isRunning();
  });
  EXPECT_THAT(log.text(),
              testing::HasSubstr("The fallback 'absent' of controller 'faulty' is not loaded"));
}

TEST_F(SupervisionTest, aFallbackInConflictStaysOut) {
  nh_.setParam("faulty/fallback_controllers", Names{"b"});  // joint j0, which a has
  renewGuarded();
  load({"b"});
  LogCatcher log;
  misbehave(Mischief::kThrow);
  EXPECT_EQ("", robot_.prepared_start_.back());
  EXPECT_FALSE(controller("b").isRunning());
  EXPECT_THAT(log.text(), testing::HasSubstr("fallbacks of controller 'faulty' were not started"));
}

TEST_F(SupervisionTest, aStartThatThrowsIsTakenBack) {
  own_.setParam("abort_faulty_controllers", true);
  renew();
  load({"a", "faulty"});
  FaultyController::inStarting() = true;
  LogCatcher log;
  EXPECT_TRUE(doSwitch({"a", "faulty"}, {}));
  EXPECT_TRUE(controller("a").isRunning());
  EXPECT_TRUE(controller("faulty").isAborted());
  EXPECT_EQ("faulty", robot_.prepared_stop_.back());
  EXPECT_EQ(2, robot_.switches_);
  EXPECT_THAT(log.text(), testing::HasSubstr("its starting threw: the target is unknown"));
}

TEST_F(SupervisionTest, badParametersAreRefusedWithASentence) {
  const auto expectRefused = [&](const std::string& name, auto value) {
    own_.setParam(name, value);
    try {
      renew();
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("/manager_test/controller_manager/" + name));
    }
    own_.deleteParam(name);
  };
  expectRefused("statistics_rate", -1.0);
  expectRefused("statistics_rate", std::string("often"));
  expectRefused("abort_faulty_controllers", 3);
  expectRefused("max_update_time", Names{"1"});
  expectRefused("default_switch_timeout", -0.5);
}

TEST_F(SupervisionTest, fallbacksMustBeNames) {
  own_.setParam("abort_faulty_controllers", true);
  nh_.setParam("faulty/fallback_controllers", 3);
  renew();
  LogCatcher log;
  EXPECT_FALSE(manager_->loadController("faulty"));
  EXPECT_TRUE(loaded().empty());
  EXPECT_THAT(log.text(), testing::HasSubstr("is no list of controllers' names"));
}

TEST_F(SupervisionTest, theDefaultTimeoutEndsASwitchWithoutLoop) {
  own_.setParam("default_switch_timeout", 0.1);
  renew();
  load({"a"});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(manager_->switchController({"a"}, {}, kStrict));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(elapsed.count(), 0.1);
  EXPECT_LT(elapsed.count(), 5.0);
}

TEST_F(SupervisionTest, statisticsTellHowLongControllersTake) {
  own_.setParam("statistics_rate", 20.0);
  renew();
  load({"a", "faulty"});
  ASSERT_TRUE(doSwitch({"faulty"}, {}));
  ros::CallbackQueue queue;
  ros::NodeHandle listener(own_);
  listener.setCallbackQueue(&queue);
  controller_manager_msgs::ControllersStatistics last;
  int messages = 0;
  const ros::Subscriber subscriber =
      listener.subscribe<controller_manager_msgs::ControllersStatistics>("statistics", 1,
                                                                         [&](const auto& message) {
                                                                           last = *message;
                                                                           ++messages;
                                                                         });
  // Each update takes 3 ms of a period of 1 ms: all are overruns.
  FaultyController::inUpdate() = Mischief::kSlow;
  waitFor([&] {
    step();
    queue.callAvailable();
    return messages > 2;
  });
  ASSERT_EQ(4u, last.controller.size());
  const auto& idle = last.controller[0];
  EXPECT_EQ("a", idle.name);
  EXPECT_EQ("dummy/Good", idle.type);
  EXPECT_FALSE(idle.running);
  EXPECT_EQ(0.0, idle.mean_time.toSec());
  const auto& busy = last.controller[1];
  EXPECT_EQ("faulty", busy.name);
  EXPECT_TRUE(busy.running);
  EXPECT_GE(busy.mean_time.toSec(), 0.003);
  EXPECT_GE(busy.max_time.toSec(), busy.mean_time.toSec());
  EXPECT_GT(busy.num_control_loop_overruns, 10);
  EXPECT_GT(busy.time_last_control_loop_overrun.toSec(), 100.0);
  const auto& execution = last.controller[2];
  EXPECT_EQ("control_loop", execution.name);
  EXPECT_EQ("execution", execution.type);
  EXPECT_GE(execution.mean_time.toSec(), busy.mean_time.toSec());
  const auto& period = last.controller[3];
  EXPECT_EQ("period", period.type);
  EXPECT_GE(period.mean_time.toSec(), execution.mean_time.toSec());
}

TEST(TimeStatistics, agreeWithTheClosedForm) {
  controller_manager::internal::TimeStatistics statistics;
  for (int i = 1; i <= 100; ++i) {
    statistics.add(1e-3 * i);
  }
  EXPECT_EQ(100u, statistics.count());
  EXPECT_NEAR(0.0505, statistics.mean(), 1e-15);
  EXPECT_NEAR((100.0 * 100.0 - 1.0) / 12.0 * 1e-6, statistics.variance(), 1e-15);
  EXPECT_EQ(0.1, statistics.max());
}
