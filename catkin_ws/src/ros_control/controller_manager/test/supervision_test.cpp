// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Functions enabled by parameters: faulty controllers are aborted alone, statistics, the default
// timeout.
#include <controller_manager/internal/command_guard.h>
#include <controller_manager/internal/time_statistics.h>
#include <controller_manager_msgs/ControllersStatistics.h>
#include <hardware_interface/position_velocity_torque_gains_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>
#include <ros/callback_queue.h>

#include <limits>
#include <numeric>

#include "supervision_fixture.h"

using dummies::FaultKind;
using dummies::FaultyController;
using dummies::kStrict;
using dummies::LogCatcher;
using dummies::SupervisionTest;

// As in the original.
TEST_F(SupervisionTest, ByDefaultExceptionsPropagateAndDoNotBlockOtherControllers) {
  for (const double statistics_rate : {0.0, 100.0}) {
    if (statistics_rate > 0.0) {
      own_.setParam("statistics_rate", statistics_rate);
    }
    FaultyController::inUpdate() = FaultKind::kNone;
    renew();
    load({"faulty", "a"});
    ASSERT_TRUE(doSwitch({"faulty", "a"}, {}));
    FaultyController::inUpdate() = FaultKind::kThrow;
    const int updates = controller("a").updates_;
    EXPECT_THROW(step(), std::runtime_error);
    EXPECT_EQ(updates + 1, controller("a").updates_) << statistics_rate;
    std::future<bool> answer = postSwitch({}, {"faulty"});
    EXPECT_GE(stepThroughExceptions(answer), 1);
    EXPECT_TRUE(answer.get());
    EXPECT_NO_THROW(step());
    EXPECT_FALSE(controller("faulty").isRunning());
  }
}

TEST_F(SupervisionTest, ByDefaultAThrowingStartEndsTheSwitch) {
  renew();
  load({"a", "faulty", "c"});
  FaultyController::throwsIn() = "starting";
  LogCatcher log;
  std::future<bool> answer = postSwitch({"a", "faulty", "c"}, {});
  EXPECT_EQ(1, stepThroughExceptions(answer));
  EXPECT_FALSE(answer.get());
  EXPECT_TRUE(controller("a").isRunning()) << "it was started before the exception";
  EXPECT_TRUE(controller("faulty").isAborted());
  EXPECT_TRUE(controller("c").isAborted());
  EXPECT_THAT(log.text(), testing::HasSubstr("loop: the target is unknown"));
  FaultyController::throwsIn().clear();
  EXPECT_TRUE(doSwitch({"faulty", "c"}, {}));
  EXPECT_TRUE(controller("faulty").isRunning());
  EXPECT_EQ(1, controller("a").starts_) << "the broken switch is over";
}

TEST_F(SupervisionTest, ByDefaultAThrowingStopEndsTheSwitch) {
  renew();
  load({"a", "faulty", "c"});
  ASSERT_TRUE(doSwitch({"a", "faulty"}, {}));
  FaultyController::throwsIn() = "stopping";
  std::future<bool> answer = postSwitch({"c"}, {"faulty", "a"});
  EXPECT_EQ(1, stepThroughExceptions(answer));
  EXPECT_FALSE(answer.get());
  for (const char* const name : {"a", "faulty", "c"}) {
    EXPECT_TRUE(controller(name).isAborted()) << name;
  }
  EXPECT_TRUE(doSwitch({"c"}, {}));
}

TEST_F(SupervisionTest, ByDefaultAThrowingRestartLeavesTheControllerStopped) {
  renew();
  load({"faulty"});
  ASSERT_TRUE(doSwitch({"faulty"}, {}));
  FaultyController::throwsIn() = "starting";
  EXPECT_THROW(step(true), std::runtime_error);
  EXPECT_TRUE(controller("faulty").isStopped());
  EXPECT_NO_THROW(step(true));
}

TEST_F(SupervisionTest, ThrowingControllerIsAbortedAlone) {
  for (const auto& [fault, text] : {std::pair(FaultKind::kThrow, "threw: the matrix is singular"),
                                    std::pair(FaultKind::kThrowNumber, "threw: an exception of")}) {
    FaultyController::inUpdate() = FaultKind::kNone;
    renewGuarded();
    LogCatcher log;
    failOnce(fault);
    EXPECT_THAT(log.text(), testing::HasSubstr(text));
    EXPECT_EQ(7.0, command("j3"));
  }
}

TEST_F(SupervisionTest, NanCommandsDoNotReachTheRobot) {
  renewGuarded();
  LogCatcher log;
  failOnce(FaultKind::kNan);
  EXPECT_THAT(log.text(), testing::HasSubstr("joint 'j3' a value that is not a number"));
  EXPECT_EQ(7.0, command("j3"));
}

TEST_F(SupervisionTest, FaultInTheFirstUpdateKeepsTheCommandOfTheStart) {
  renewGuarded();
  step();
  ASSERT_EQ(7.0, command("j3")) << "of an earlier run";
  for (const FaultKind fault : {FaultKind::kNan, FaultKind::kThrow}) {
    FaultyController::inUpdate() = FaultKind::kNone;
    ASSERT_TRUE(doSwitch({}, {"faulty"}, dummies::kBestEffort));
    FaultyController::inUpdate() = fault;
    const int switches = robot_.switches_;
    ASSERT_TRUE(doSwitch({"faulty"}, {}));
    stepUntilNotified(switches + 1);
    EXPECT_TRUE(controller("faulty").isAborted());
    EXPECT_EQ(FaultyController::kFirstCommand, command("j3"));
  }
}

TEST_F(SupervisionTest, ThrowingRestartIsAbortedAlone) {
  for (const char* const callback : {"stopping", "starting"}) {
    FaultyController::throwsIn().clear();
    renewGuarded();
    step();
    const int switches = robot_.switches_;
    FaultyController::throwsIn() = callback;
    LogCatcher log;
    EXPECT_NO_THROW(step(true));
    EXPECT_TRUE(controller("faulty").isAborted()) << callback;
    EXPECT_EQ(7.0, command("j3"));
    EXPECT_EQ(2, controller("a").starts_);
    EXPECT_TRUE(controller("a").isRunning());
    stepUntilNotified(switches);
    EXPECT_EQ("faulty", robot_.prepared_stop_.back());
    EXPECT_THAT(log.text(), testing::HasSubstr("its restart threw: the target is unknown"));
  }
}

TEST_F(SupervisionTest, RestartIsSupervised) {
  renewGuarded();
  step(true);
  for (const char* const name : {"a", "faulty"}) {
    EXPECT_TRUE(controller(name).isRunning());
    EXPECT_EQ(1, controller(name).stops_);
    EXPECT_EQ(2, controller(name).starts_);
  }
}

TEST_F(SupervisionTest, ThrowingWaitIsAbortedAlone) {
  own_.setParam("abort_faulty_controllers", true);
  for (const bool asap : {false, true}) {
    renew();
    load({"a", "faulty"});
    robot_.script_.assign(static_cast<std::size_t>(robot_.result_calls_) + 8,
                          hardware_interface::RobotHW::SwitchState::ONGOING);
    FaultyController::throwsIn() = "waiting";
    LogCatcher log;
    EXPECT_TRUE(doSwitch({"a", "faulty"}, {}, kStrict, asap));
    EXPECT_TRUE(controller("a").isRunning());
    EXPECT_TRUE(controller("faulty").isAborted());
    EXPECT_EQ(0, controller("faulty").starts_);
    EXPECT_EQ("faulty", robot_.prepared_stop_.back());
    EXPECT_THAT(log.text(), testing::HasSubstr("its waiting threw: the target is unknown"));
  }
}

TEST_F(SupervisionTest, ThrowingAbortIsCaught) {
  own_.setParam("abort_faulty_controllers", true);
  robot_.after_script_ = hardware_interface::RobotHW::SwitchState::ERROR;
  FaultyController::throwsIn() = "aborting";
  for (const bool asap : {false, true}) {
    renew();
    load({"faulty", "a"});
    LogCatcher log;
    EXPECT_TRUE(doSwitch({"faulty", "a"}, {}, kStrict, asap));
    EXPECT_TRUE(controller("faulty").isAborted());
    EXPECT_EQ(1, controller("a").aborts_);
    EXPECT_THAT(log.text(), testing::HasSubstr("Controller 'faulty' threw in its aborting"));
  }
}

TEST_F(SupervisionTest, RobotIsNotifiedAfterALongSwitch) {
  renewGuarded();
  load({"c"});
  robot_.after_script_ = hardware_interface::RobotHW::SwitchState::ONGOING;
  std::future<bool> answer = beginSwitch({"c"}, {});
  LogCatcher log;
  FaultyController::inUpdate() = FaultKind::kThrow;
  waitFor([&] {
    step();
    return log.text().find("another switch is under way") != std::string::npos;
  });
  const int switches = robot_.switches_;
  robot_.after_script_ = hardware_interface::RobotHW::SwitchState::DONE;
  EXPECT_TRUE(stepUntil(std::move(answer)));
  stepUntilNotified(switches);
  EXPECT_EQ("faulty", robot_.prepared_stop_.back());
}

TEST_F(SupervisionTest, SlowControllerIsAborted) {
  own_.setParam("max_update_time", 1000.0);
  renewGuarded();
  step();
  EXPECT_TRUE(controller("faulty").isRunning());
  own_.setParam("max_update_time", 1e-9);  // less than any update takes
  renew();
  load({"faulty"});
  LogCatcher log;
  ASSERT_TRUE(doSwitch({"faulty"}, {}));
  waitFor([&] {
    step();
    return log.text().find("max_update_time allows 0.000") != std::string::npos;
  });
  EXPECT_TRUE(controller("faulty").isAborted());
}

TEST_F(SupervisionTest, AbortedControllerCanRestartAndFailAgain) {
  renewGuarded();
  for (int i = 1; i <= 3; ++i) {
    const int switches = robot_.switches_;
    FaultyController::inUpdate() = FaultKind::kThrow;
    step();
    stepUntilNotified(switches);
    FaultyController::inUpdate() = FaultKind::kNone;
    ASSERT_TRUE(doSwitch({"faulty"}, {}));
    EXPECT_TRUE(controller("faulty").isRunning());
    EXPECT_EQ(i, controller("faulty").aborts_);
  }
}

TEST_F(SupervisionTest, FallbackTakesOver) {
  nh_.setParam("faulty/fallback_controllers", Names{"c", "absent"});
  renewGuarded();
  load({"c"});
  LogCatcher log;
  failOnce(FaultKind::kThrow);
  EXPECT_EQ("c", robot_.prepared_start_.back());
  waitFor([&] {
    step();
    return controller("c").isRunning();
  });
  EXPECT_THAT(log.text(), testing::HasSubstr("fallback 'absent'"));
}

TEST_F(SupervisionTest, ConflictingFallbackIsNotStarted) {
  nh_.setParam("faulty/fallback_controllers", Names{"b"});  // joint j0, which a has
  renewGuarded();
  load({"b"});
  LogCatcher log;
  failOnce(FaultKind::kThrow);
  EXPECT_EQ("", robot_.prepared_start_.back());
  EXPECT_FALSE(controller("b").isRunning());
  EXPECT_THAT(log.text(), testing::HasSubstr("fallbacks of controller 'faulty' were not started"));
}

TEST_F(SupervisionTest, ThrowingStartIsAborted) {
  own_.setParam("abort_faulty_controllers", true);
  renew();
  load({"a", "faulty"});
  FaultyController::throwsIn() = "starting";
  LogCatcher log;
  EXPECT_TRUE(doSwitch({"a", "faulty"}, {}));
  EXPECT_TRUE(controller("a").isRunning());
  EXPECT_TRUE(controller("faulty").isAborted());
  EXPECT_EQ("faulty", robot_.prepared_stop_.back());
  EXPECT_EQ(2, robot_.switches_);
  EXPECT_THAT(log.text(), testing::HasSubstr("its starting threw: the target is unknown"));
}

TEST_F(SupervisionTest, BadParametersAreRefusedWithASentence) {
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

TEST_F(SupervisionTest, FallbacksMustBeNames) {
  own_.setParam("abort_faulty_controllers", true);
  nh_.setParam("faulty/fallback_controllers", 3);
  renew();
  LogCatcher log;
  EXPECT_FALSE(manager_->loadController("faulty"));
  EXPECT_TRUE(loaded().empty());
  EXPECT_THAT(log.text(), testing::HasSubstr("is not a list of controllers' names"));
}

TEST_F(SupervisionTest, DefaultTimeoutEndsASwitchWithoutTheLoop) {
  own_.setParam("default_switch_timeout", 0.1);
  renew();
  load({"a"});
  EXPECT_FALSE(manager_->switchController({"a"}, {}, kStrict));
}

TEST_F(SupervisionTest, StatisticsReportUpdateTimes) {
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
  FaultyController::inUpdate() = FaultKind::kSlow;
  waitFor([&] {
    step();
    queue.callAvailable();
    return messages > 2 && last.controller.at(1).running &&
           last.controller[1].num_control_loop_overruns > 10;
  });
  ASSERT_EQ(4u, last.controller.size());
  const auto& idle = last.controller[0];
  EXPECT_EQ("a", idle.name);
  EXPECT_EQ("dummy/Good", idle.type);
  EXPECT_FALSE(idle.running);
  EXPECT_EQ(0.0, idle.mean_time.toSec());
  const auto& busy = last.controller[1];
  EXPECT_EQ("faulty", busy.name);
  EXPECT_GE(busy.mean_time.toSec(), 0.003);
  EXPECT_GE(busy.max_time.toSec(), busy.mean_time.toSec());
  EXPECT_GT(busy.time_last_control_loop_overrun.toSec(), 100.0);
  const auto& execution = last.controller[2];
  EXPECT_EQ("control_loop", execution.name);
  EXPECT_EQ("execution", execution.type);
  EXPECT_GE(execution.mean_time.toSec(), busy.mean_time.toSec());
  const auto& period = last.controller[3];
  EXPECT_EQ("period", period.type);
  EXPECT_GE(period.mean_time.toSec(), 0.003);
}

TEST(CommandGuard, ChecksAllCommandsOfAllJointInterfaces) {
  namespace hw = hardware_interface;
  const double measured = 0.25;
  double numbers[5] = {};
  double* const n = numbers;
  const hw::JointStateHandle state("elbow", &measured, &measured, &measured);
  hw::EffortJointInterface effort;
  hw::VelocityJointInterface velocity;
  hw::PositionJointInterface position;
  hw::PosVelJointInterface pos_vel;
  hw::PosVelAccJointInterface pos_vel_acc;
  hw::PositionVelocityTorqueGainsJointInterface gains;
  effort.registerHandle({state, n});
  velocity.registerHandle({state, n});
  position.registerHandle({state, n});
  pos_vel.registerHandle({state, n, n + 1});
  pos_vel_acc.registerHandle({state, n, n + 1, n + 2});
  gains.registerHandle({state, n, n + 1, n + 2, n + 3, n + 4});
  hw::RobotHW robot;
  robot.registerInterface(&effort);
  robot.registerInterface(&velocity);
  robot.registerInterface(&position);
  robot.registerInterface(&pos_vel);
  robot.registerInterface(&pos_vel_acc);
  robot.registerInterface(&gains);

  struct Case {
    const char* interface;
    int numbers;
    double rest;  // of the first number
  };
  for (const Case& tried :
       {Case{"EffortJointInterface", 1, 0.0}, Case{"VelocityJointInterface", 1, 0.0},
        Case{"PositionJointInterface", 1, measured}, Case{"PosVelJointInterface", 2, measured},
        Case{"PosVelAccJointInterface", 3, measured},
        Case{"PositionVelocityTorqueGainsJointInterface", 5, measured}}) {
    SCOPED_TRACE(tried.interface);
    hw::ControllerInfo info;
    info.claimed_resources = {{std::string("hardware_interface::") + tried.interface, {"elbow"}}};
    controller_manager::internal::CommandGuard guard(info, robot);
    for (int i = 0; i < tried.numbers; ++i) {
      const double nan = std::numeric_limits<double>::quiet_NaN();
      std::iota(numbers, numbers + 5, 1.0);
      guard.remember();
      EXPECT_EQ(nullptr, guard.offender());
      numbers[i] = nan;
      EXPECT_STREQ("elbow", guard.offender());
      guard.restore();
      EXPECT_EQ(i + 1.0, numbers[i]);
      numbers[i] = nan;
      guard.remember();
      guard.restore();
      EXPECT_EQ(i == 0 ? tried.rest : 0.0, numbers[i]);
    }
  }
  EXPECT_TRUE(gains.getClaims().empty());
}

TEST(TimeStatistics, AgreeWithTheClosedForm) {
  controller_manager::internal::TimeStatistics statistics;
  for (int i = 1; i <= 100; ++i) {
    statistics.add(1e-3 * i);
  }
  EXPECT_EQ(100u, statistics.count());
  EXPECT_NEAR(0.0505, statistics.mean(), 1e-15);
  EXPECT_NEAR((100.0 * 100.0 - 1.0) / 12.0 * 1e-6, statistics.variance(), 1e-15);
  EXPECT_EQ(0.1, statistics.max());
}
