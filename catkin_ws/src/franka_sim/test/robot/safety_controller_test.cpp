// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The rules of Desk: what is refused when, and what stops and errors do to brakes, FCI and motions.
#include <franka_sim/robot/safety/safety_controller.h>
#include <franka_sim/robot/whole_robot.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fci_fixture.h"

namespace franka_sim {
namespace {

using test::RobotMode;
using Light = LightColor;

class SafetyTest : public test::FciTest, public ::testing::WithParamInterface<bool> {
 protected:
  SafetyTest() : fr3(GetParam()), safety(unit, fr3), motion(unit) {
    safety.setBrakeTime(0.07);
    safety.setSelfTestTime(0.05);
    safety.start(SafetyRules::kDesk);
    tick(5);
  }

  void tick(int ticks) {
    for (int i = 0; i < ticks; i++) {
      unit.observe(arm.measure());
      safety.step();
      arm.applyTorques(unit.actuate(motion.command()));
      arm.setBrakes(unit.status().brakes_closed);
      arm.step();
    }
  }

  void settle() {
    for (int i = 0; i < 3000 && (safety.busy() || unit.status().settling); i++) {
      tick(1);
    }
  }

  void makeReady() {
    ASSERT_EQ(Refusal::kNone, safety.unlock());
    settle();
    ASSERT_EQ(Refusal::kNone, safety.activateFci());
  }

  void startTorqueMotion() {
    ASSERT_EQ(Status::kMotionStarted, unit.request(torqueControl()));
    tick(3);
    ASSERT_EQ(RobotMode::kMove, unit.state().robot_mode);
  }

  std::ptrdiff_t closedBrakes() const {
    const auto& closed = safety.state().brakes_closed;
    return std::count(closed.begin(), closed.end(), true);
  }

  std::optional<Status> motionEnd() { return unit.takeAnswer(PendingAnswer::kMotion); }

  bool fr3;
  SafetyController safety;
  OperatorMotion motion;
};

TEST_P(SafetyTest, BrakesOpenOneAfterTheOther) {
  ASSERT_EQ(Refusal::kNone, safety.unlock());
  std::ptrdiff_t last = 7;
  for (int i = 0; i < 70; i++) {
    tick(1);
    EXPECT_GE(last, closedBrakes());
    EXPECT_LE(last - 1, closedBrakes());
    last = closedBrakes();
    EXPECT_EQ(last > 0 ? RobotMode::kOther : unit.state().robot_mode, unit.state().robot_mode);
  }
  tick(2);
  EXPECT_EQ(0, closedBrakes());
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
  EXPECT_EQ(Light::kBlue, safety.light().color);
  EXPECT_EQ(Refusal::kNone, safety.unlock());
  EXPECT_FALSE(safety.busy());
}

TEST_P(SafetyTest, StartsLockedAndFciNeedsOpenBrakes) {
  EXPECT_EQ(7, closedBrakes());
  EXPECT_EQ(RobotMode::kOther, unit.state().robot_mode);
  EXPECT_EQ(Light::kYellow, safety.light().color);
  EXPECT_FALSE(safety.handServed());
  EXPECT_EQ(Refusal::kBrakesClosed, safety.activateFci());
  EXPECT_FALSE(safety.fciActive());
  makeReady();
  EXPECT_TRUE(safety.fciActive());
  EXPECT_TRUE(safety.handServed());
}

TEST_P(SafetyTest, LockingAndDeactivationEndMotionAndFci) {
  for (const bool locks : {true, false}) {
    makeReady();
    startTorqueMotion();
    locks ? safety.lock() : safety.deactivateFci();
    EXPECT_EQ(Status::kAborted, motionEnd());
    settle();
    EXPECT_EQ(locks ? 7 : 0, closedBrakes());
    EXPECT_FALSE(safety.fciActive());
    EXPECT_EQ(locks ? RobotMode::kOther : RobotMode::kIdle, unit.state().robot_mode);
  }
}

TEST_P(SafetyTest, StopOfTheRobotAbortsAndLocksAnFr3Only) {
  makeReady();
  startTorqueMotion();
  safety.press(fr3 ? SafetyInput::kX31 : SafetyInput::kX4, true);
  EXPECT_EQ(Status::kEmergencyAborted, motionEnd());
  settle();
  EXPECT_EQ(fr3 ? 7 : 0, closedBrakes());
  EXPECT_EQ(!fr3, safety.fciActive());
  EXPECT_EQ(fr3 ? Light::kYellow : Light::kWhite, safety.light().color);
  EXPECT_EQ(Refusal::kEmergencyStopPressed, fr3 ? safety.unlock() : safety.allowsOperatorMotion());
  safety.press(fr3 ? SafetyInput::kX31 : SafetyInput::kX4, false);
  settle();
  if (fr3) {
    makeReady();
  }
  tick(5);
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
}

TEST_P(SafetyTest, SecondStopOfAnFr3KeepsTheFci) {
  makeReady();
  safety.press(SafetyInput::kX32, true);
  settle();
  EXPECT_EQ(fr3 ? RobotMode::kUserStopped : RobotMode::kIdle, unit.state().robot_mode);
  EXPECT_TRUE(safety.fciActive());
  EXPECT_EQ(0, closedBrakes());
}

TEST_P(SafetyTest, ProgrammingEndsTheFci) {
  makeReady();
  startTorqueMotion();
  if (!fr3) {
    return;
  }
  ASSERT_EQ(Refusal::kNone, safety.setOperatingMode(OperatingMode::kProgramming));
  EXPECT_EQ(Status::kAborted, motionEnd());
  EXPECT_FALSE(safety.fciActive());
  EXPECT_EQ(Refusal::kWrongOperatingMode, safety.activateFci());
  EXPECT_EQ(Light::kWhite, safety.light().color);
  ASSERT_EQ(Refusal::kNone, safety.setOperatingMode(OperatingMode::kExecution));
  settle();
  EXPECT_EQ(Refusal::kNone, safety.activateFci());
}

TEST_P(SafetyTest, GuidingOnlyWhereItIsAllowed) {
  EXPECT_EQ(Refusal::kBrakesClosed, safety.guide(true));
  safety.guide(false);
  makeReady();
  EXPECT_EQ(Refusal::kWrongOperatingMode, safety.guide(true));
  EXPECT_EQ(Light::kPink, safety.light().color);
  safety.guide(false);
  if (fr3) {
    ASSERT_EQ(Refusal::kNone, safety.setOperatingMode(OperatingMode::kProgramming));
    for (const SafetyInput stop : {SafetyInput::kX32, SafetyInput::kX33}) {
      safety.press(stop, true);
      tick(5);
      EXPECT_EQ(Refusal::kWrongOperatingMode, safety.guide(true));
      tick(5);
      EXPECT_EQ(RobotMode::kUserStopped, unit.state().robot_mode);
      safety.guide(false);
      safety.press(stop, false);
      settle();
    }
  } else {
    EXPECT_EQ(Light::kPink, safety.light().color);  // until the activation device is pressed
    safety.press(SafetyInput::kX4, true);
  }
  settle();
  EXPECT_EQ(Light::kWhite, safety.light().color);
  ASSERT_EQ(Refusal::kNone, safety.guide(true));
  tick(5);
  EXPECT_EQ(RobotMode::kGuiding, unit.state().robot_mode);
  safety.guide(false);
  settle();
  EXPECT_EQ(fr3 ? RobotMode::kIdle : RobotMode::kUserStopped, unit.state().robot_mode);
  safety.press(SafetyInput::kX4, false);
  settle();
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
}

TEST_P(SafetyTest, TheStopOutlastsGuidingAndPower) {
  const SafetyInput stop = fr3 ? SafetyInput::kX33 : SafetyInput::kX4;
  safety.start(SafetyRules::kOpen);
  tick(5);
  ASSERT_EQ(Refusal::kNone, safety.guide(true));
  safety.press(stop, true);
  safety.guide(false);
  settle();
  EXPECT_EQ(RobotMode::kUserStopped, unit.state().robot_mode);
  EXPECT_EQ(Refusal::kEmergencyStopPressed, safety.guide(true));
  EXPECT_FALSE(safety.pressed(SafetyInput::kGuidingButton)) << "a refused request has no effect";
  for (const bool of_operator : {false, true}) {
    safety.pressUserStop(of_operator);
    safety.press(stop, !of_operator);
    safety.switchOff();
    safety.start(SafetyRules::kOpen);
    settle();
    EXPECT_EQ(RobotMode::kUserStopped, unit.state().robot_mode) << of_operator;
  }
  safety.pressUserStop(false);
  settle();
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
}

TEST_P(SafetyTest, SelfTestWithOpenRulesRestoresWhatItFound) {
  for (const bool closed : {false, true}) {
    for (const bool active : {false, true}) {
      safety.start(SafetyRules::kOpen);
      closed ? safety.lock() : static_cast<void>(safety.unlock());
      active ? static_cast<void>(safety.activateFci()) : safety.deactivateFci();
      settle();
      const RobotMode mode = unit.state().robot_mode;
      safety.pressUserStop(true);
      settle();
      ASSERT_EQ(Refusal::kNone, safety.startSelfTest());
      settle();
      safety.pressUserStop(false);
      settle();
      tick(3);
      EXPECT_EQ(mode, unit.state().robot_mode);
      EXPECT_EQ(closed ? 7 : 0, closedBrakes());
      EXPECT_EQ(active, safety.fciActive());
    }
  }
}

TEST_P(SafetyTest, NothingDisturbsTheSelfTest) {
  for (const SafetyRules rules : {SafetyRules::kOpen, SafetyRules::kDesk}) {
    safety.start(rules);
    ASSERT_EQ(Refusal::kNone, safety.unlock());
    settle();
    ASSERT_EQ(Refusal::kNone, safety.startSelfTest());
    tick(2);
    EXPECT_EQ(Refusal::kSelfTestRunning, safety.unlock());
    EXPECT_EQ(Refusal::kSelfTestRunning, safety.activateFci());
    EXPECT_EQ(Refusal::kSelfTestRunning, safety.guide(true));
    EXPECT_EQ(Refusal::kSelfTestRunning, safety.startSelfTest());
    EXPECT_EQ(Refusal::kSelfTestRunning, safety.allowsOperatorMotion());
    EXPECT_EQ(Refusal::kSelfTestRunning, safety.setOperatingMode(OperatingMode::kProgramming));
    tick(2);
    EXPECT_TRUE(safety.state().self_test);
    EXPECT_EQ(RobotMode::kOther, unit.state().robot_mode);
    EXPECT_FALSE(safety.fciActive());
    // What is never refused has its effect at the end.
    safety.lock();
    safety.deactivateFci();
    settle();
    tick(3);
    EXPECT_EQ(RobotMode::kOther, unit.state().robot_mode);
    EXPECT_FALSE(safety.fciActive());
    safety.guide(false);
  }
}

TEST_P(SafetyTest, SelfTestClosesBrakesAndRestartsItsClock) {
  makeReady();
  safety.setSelfTestDue(100.0);
  ASSERT_EQ(Refusal::kNone, safety.startSelfTest());
  EXPECT_EQ(7, closedBrakes());
  EXPECT_EQ(Refusal::kSelfTestRunning, safety.unlock());
  EXPECT_GE(100.0, safety.state().self_test_due);
  settle();
  EXPECT_FALSE(safety.state().self_test);
  EXPECT_NEAR(86400.0, safety.state().self_test_due, 0.1);
  EXPECT_EQ(7, closedBrakes());
  makeReady();
}

TEST_P(SafetyTest, OverdueSelfTestLocksUntilAcknowledged) {
  for (const int due : {0, 10}) {
    makeReady();
    safety.setSelfTestDue(1e-3 * due);
    tick(std::max(0, due - 2));
    EXPECT_EQ(0, closedBrakes()) << "not yet due";
    tick(3);
    settle();
    EXPECT_EQ(7, closedBrakes());
    EXPECT_EQ(Light::kRed, safety.light().color);
    EXPECT_EQ(Refusal::kRecoverableErrorActive, safety.unlock());
    EXPECT_EQ(Refusal::kRecoverableErrorActive, safety.startSelfTest());
    EXPECT_EQ(Refusal::kNone, safety.acknowledge(RecoverableError::kTd2Timeout));
    EXPECT_EQ(Refusal::kNoAckRequired, safety.acknowledge(RecoverableError::kTd2Timeout));
    ASSERT_EQ(Refusal::kNone, safety.startSelfTest());
    settle();
  }
  makeReady();
}

TEST_P(SafetyTest, DemandedRecoveryNeedsTheEnablingDevice) {
  makeReady();
  safety.inject(DemandedRecovery::kJointLimitViolation, 3, true);
  settle();
  EXPECT_EQ(7, closedBrakes());
  EXPECT_EQ(Refusal::kJointRecoveryRequired, safety.unlock());
  EXPECT_EQ(Refusal::kJointRecoveryRequired,
            safety.acknowledge(DemandedRecovery::kJointLimitViolation));
  safety.press(SafetyInput::kX4, true);
  EXPECT_EQ(Refusal::kNone, safety.acknowledge(DemandedRecovery::kJointLimitViolation));
  safety.press(SafetyInput::kX4, false);
  settle();
  makeReady();
}

TEST_P(SafetyTest, OperatorMotionNeedsOpenBrakesWithoutFci) {
  EXPECT_EQ(Refusal::kBrakesClosed, safety.allowsOperatorMotion());
  makeReady();
  EXPECT_EQ(Refusal::kMotionActive, safety.allowsOperatorMotion());
  safety.deactivateFci();
  EXPECT_EQ(Refusal::kNone, safety.allowsOperatorMotion());
}

TEST_P(SafetyTest, PowerOffRefusesEverything) {
  makeReady();
  safety.switchOff();
  EXPECT_EQ(Refusal::kNotReady, safety.unlock());
  EXPECT_EQ(Refusal::kNotReady, safety.activateFci());
  EXPECT_EQ(Refusal::kNotReady, safety.startSelfTest());
  settle();
  safety.start(SafetyRules::kDesk);
  tick(5);
  EXPECT_EQ(7, closedBrakes());
  makeReady();
}

TEST_P(SafetyTest, OpenRulesRefuseNothing) {
  safety.start(SafetyRules::kOpen);
  tick(5);
  EXPECT_TRUE(safety.fciActive());
  EXPECT_EQ(0, closedBrakes());
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
  safety.setSelfTestDue(0.001);
  tick(5);
  EXPECT_TRUE(safety.fciActive());
  EXPECT_EQ(Refusal::kNone, safety.guide(true));
  EXPECT_EQ(RobotMode::kGuiding, unit.state().robot_mode);
}

INSTANTIATE_TEST_SUITE_P(Robots, SafetyTest, ::testing::Bool(),
                         [](const auto& robot) { return robot.param ? "Fr3" : "Panda"; });

}  // namespace
}  // namespace franka_sim
