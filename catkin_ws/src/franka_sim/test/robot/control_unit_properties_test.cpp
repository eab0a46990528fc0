// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Rules of a robot's units that hold in every sequence of requests, inputs, commands and ticks. A
// failure prints the smallest sequence that RapidCheck finds.
//
// Seeds are fixed, except in the long form, which also runs more sequences. RC_PARAMS overrides
// both: RC_PARAMS="seed=7 max_success=100000".
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "properties/invariants.h"
#include "properties/stepped_robot.h"

namespace franka_sim::test {

namespace {

using Answer = SteppedRobot::Answer;

// RapidCheck reads its parameters before its first property.
const bool kParametersSet = [] {
  const char* const long_form = std::getenv("FRANKA_TEST_LONG");
  const bool is_long = long_form != nullptr && std::string(long_form) == "1";
  const char* const parameters =
      is_long ? "max_success=50000 max_size=60" : "seed=1 max_success=2000 max_size=40";
  return setenv("RC_PARAMS", parameters, 0) == 0;
}();

RC_GTEST_PROP(ControlUnitProperties, EveryStepKeepsTheRules, ()) {
  RC_ASSERT(kParametersSet);
  SteppedRobot robot(*settings());
  Invariants invariants(robot);
  for (const Step& step : *sequences()) {
    const std::string broken = invariants.run(robot, step);
    if (!broken.empty()) {
      RC_FAIL(broken);
    }
  }
}

// One robot gets all requests, another one only those that the first one accepts.
RC_GTEST_PROP(ControlUnitProperties, RefusedRequestsLeaveNoTrace, ()) {
  const Setting setting = *settings();
  SteppedRobot robot(setting);
  SteppedRobot twin(setting);
  for (const Step& step : *sequences()) {
    if (robot.act(step) != Answer::kRefused) {
      RC_ASSERT(twin.act(step) != Answer::kRefused);
    }
    robot.run(step.ticks);
    twin.run(step.ticks);
    RC_ASSERT(robot.observation().differences(twin.observation()) == "");
    RC_ASSERT(robot.trace() == twin.trace());
  }
}

// A copy of the condition is complete, whatever the other robot did before.
RC_GTEST_PROP(ControlUnitProperties, ARobotContinuesAsTheOneThatItWasAssigned, ()) {
  const Setting setting = *settings();
  SteppedRobot robot(setting);
  SteppedRobot copy(setting);
  for (const Step& step : *sequences().as("of the robot")) {
    robot.act(step);
    robot.run(step.ticks);
  }
  for (const Step& step : *sequences().as("of the other one")) {
    copy.act(step);
    copy.run(step.ticks);
  }
  copy.takeOver(robot);
  for (const Step& step : *sequences().as("of both")) {
    RC_ASSERT(robot.act(step) == copy.act(step));
    robot.run(step.ticks);
    copy.run(step.ticks);
    RC_ASSERT(robot.observation().differences(copy.observation()) == "");
    RC_ASSERT(robot.arm().torques() == copy.arm().torques());
  }
}

// Two robots in turns, and each alone: equal bits.
RC_GTEST_PROP(ControlUnitProperties, RobotsDoNotInfluenceEachOther, ()) {
  const std::vector<Setting> chosen{*settings(), *settings()};
  const std::vector<std::vector<Step>> steps{*sequences(), *sequences()};
  SteppedRobot left(chosen[0]);
  SteppedRobot right(chosen[1]);
  for (std::size_t i = 0; i < steps[0].size() || i < steps[1].size(); i++) {
    if (i < steps[0].size()) {
      left.act(steps[0][i]);
    }
    if (i < steps[1].size()) {
      right.act(steps[1][i]);
    }
    for (unsigned tick = 0; tick < 60; tick++) {
      if (i < steps[0].size() && tick < steps[0][i].ticks) {
        left.tick();
      }
      if (i < steps[1].size() && tick < steps[1][i].ticks) {
        right.tick();
      }
    }
  }
  const std::vector<std::uint64_t> together{left.trace(), right.trace()};
  for (std::size_t k = 0; k < 2; k++) {
    SteppedRobot alone(chosen[k]);
    for (const Step& step : steps[k]) {
      alone.act(step);
      alone.run(step.ticks);
    }
    RC_ASSERT(alone.trace() == together[k]);
  }
}

/// Does what an operator does to make a robot ready, whatever has happened.
void makeReady(SteppedRobot& robot) {
  SafetyController& safety = robot.robot().safety();
  robot.act({Action::kFci, 1});
  robot.act({Action::kPower, 0});
  robot.act({Action::kPush, 20});
  robot.act({Action::kGuide, 1});
  robot.run(20);  // a self-test ends
  for (std::size_t i = 0; i < kRecoverableErrorCount; i++) {
    safety.acknowledge(static_cast<RecoverableError>(i));
  }
  robot.press(SafetyInput::kX4, true);
  safety.acknowledge(DemandedRecovery::kJointLimitViolation);
  safety.acknowledge(DemandedRecovery::kJointPositionError);
  for (const SafetyInput input :
       {SafetyInput::kX31, SafetyInput::kX32, SafetyInput::kX33, SafetyInput::kX4}) {
    robot.press(input, false);
  }
  robot.pressUserStop(false);
  for (int i = 0; i < 20000 && robot.robot().unit().status().settling; i++) {
    robot.tick();
  }
  if (robot.setting().isFr3()) {
    safety.setOperatingMode(OperatingMode::kExecution);
  }
  safety.setSelfTestDue(1000.0);
  safety.unlock();
  robot.run(20);
  safety.activateFci();
  robot.place();
  robot.run(2);
  robot.act({Action::kRecover, 0});
  robot.run(250);
}

// After every sequence the robot can be made ready, and then moves.
RC_GTEST_PROP(ControlUnitProperties, EveryConditionCanBeLeft, ()) {
  SteppedRobot robot(*settings());
  for (const Step& step : *sequences()) {
    robot.act(step);
    robot.run(step.ticks);
  }
  makeReady(robot);
  RC_ASSERT(static_cast<int>(robot.state().robot_mode) ==
            static_cast<int>(franka_core::RobotMode::kIdle));
  robot.act({Action::kSend, 2});
  RC_ASSERT(robot.act({Action::kMove, 0}) == Answer::kDone);
  const std::array<double, 7> start = robot.state().q_d;
  robot.run(100);
  RC_ASSERT(robot.state().robot_mode == franka_core::RobotMode::kMove);
  RC_ASSERT(robot.state().q_d[0] > start[0] + 1e-3);
}

}  // namespace

}  // namespace franka_sim::test
