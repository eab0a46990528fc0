// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/arm_state.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <map>
#include <thread>
#include <utility>
#include <vector>

namespace franka_hw {
namespace {

/// The state after a first connection and these events.
ArmState connectedAfter(std::initializer_list<ArmEvent> events) {
  ArmStateMachine machine;
  machine.handle(ArmEvent::kConnected);
  for (const ArmEvent event : events) {
    machine.handle(event);
  }
  return machine.state();
}

std::vector<ArmState> allStates() {
  std::vector<ArmState> states;
  for (int i = 0; i < kArmStateCount; i++) {
    states.push_back(static_cast<ArmState>(i));
  }
  return states;
}

TEST(ArmState, BeginsDisconnected) {
  EXPECT_EQ(ArmState::kDisconnected, ArmStateMachine().state());
}

TEST(ArmState, MovesOnlyFromIdle) {
  for (const ArmState state : allStates()) {
    ArmStateMachine machine(state);
    EXPECT_EQ(state == ArmState::kIdle, machine.handle(ArmEvent::kMotionStarted));
  }
}

TEST(ArmState, MotionThatEndsInOrderLeavesNoError) {
  EXPECT_EQ(ArmState::kIdle, connectedAfter({ArmEvent::kMotionStarted, ArmEvent::kMotionEnded}));
}

TEST(ArmState, ErrorWithinAMotionStaysWhenTheMotionHasEnded) {
  EXPECT_EQ(ArmState::kBraking, connectedAfter({ArmEvent::kMotionStarted, ArmEvent::kFailed}));
  EXPECT_EQ(ArmState::kError,
            connectedAfter({ArmEvent::kMotionStarted, ArmEvent::kFailed, ArmEvent::kMotionEnded}));
}

TEST(ArmState, RobotThatIsIdleAgainHasRecoveredFromItsOwnErrorOnly) {
  EXPECT_EQ(ArmState::kIdle,
            connectedAfter({ArmEvent::kRobotStopped, ArmEvent::kRecoveredElsewhere}));
  EXPECT_EQ(ArmState::kError, connectedAfter({ArmEvent::kFailed, ArmEvent::kRecoveredElsewhere}));
  EXPECT_EQ(ArmState::kError, connectedAfter({ArmEvent::kRobotStopped, ArmEvent::kFailed,
                                              ArmEvent::kRecoveredElsewhere}));
}

TEST(ArmState, RecoveryEndsBothKindsOfErrors) {
  EXPECT_EQ(ArmState::kIdle, connectedAfter({ArmEvent::kRobotStopped, ArmEvent::kRecovered}));
  EXPECT_EQ(ArmState::kIdle, connectedAfter({ArmEvent::kFailed, ArmEvent::kRecovered}));
}

TEST(ArmState, RecoveryThatComesTooLateLeavesALostRobotInError) {
  EXPECT_EQ(ArmState::kLostInError,
            connectedAfter({ArmEvent::kFailed, ArmEvent::kLost, ArmEvent::kRecovered}));
}

TEST(ArmState, RobotThatWasLostAtRestComesBackIdle) {
  EXPECT_EQ(ArmState::kIdle, connectedAfter({ArmEvent::kLost, ArmEvent::kConnected}));
}

TEST(ArmState, RobotThatWasLostInErrorComesBackInError) {
  EXPECT_EQ(ArmState::kError,
            connectedAfter({ArmEvent::kFailed, ArmEvent::kLost, ArmEvent::kConnected}));
  EXPECT_EQ(ArmState::kError,
            connectedAfter({ArmEvent::kRobotStopped, ArmEvent::kLost, ArmEvent::kConnected}));
  EXPECT_EQ(ArmState::kError,
            connectedAfter({ArmEvent::kLost, ArmEvent::kFailed, ArmEvent::kConnected}));
}

TEST(ArmState, RobotThatIsGivenUpHasNoErrorAndIsNotLost) {
  for (const ArmState state : allStates()) {
    ArmStateMachine machine(state);
    if (machine.handle(ArmEvent::kGivenUp)) {
      EXPECT_EQ(ArmState::kDisconnected, machine.state());
      EXPECT_FALSE(isInMotion(state)) << "a motion keeps its robot";
    } else {
      EXPECT_TRUE(isInMotion(state) || state == ArmState::kDisconnected);
    }
  }
}

TEST(ArmState, ErrorIsNeverOverlooked) {
  for (const ArmState state : allStates()) {
    ArmStateMachine machine(state);
    machine.handle(ArmEvent::kFailed);
    EXPECT_TRUE(isInError(machine.state())) << static_cast<int>(state);
  }
}

TEST(ArmState, OnlyRecoveriesAndTheUserEndAnError) {
  for (const ArmState state : allStates()) {
    for (int i = 0; i < kArmEventCount; i++) {
      const auto event = static_cast<ArmEvent>(i);
      ArmStateMachine machine(state);
      machine.handle(event);
      if (isInError(state) && !isInError(machine.state())) {
        EXPECT_TRUE(event == ArmEvent::kRecovered || event == ArmEvent::kRecoveredElsewhere ||
                    event == ArmEvent::kGivenUp);
      }
    }
  }
}

TEST(ArmState, IsConnectedInMotionInErrorOrLost) {
  const std::map<ArmState, std::vector<bool>> expected{
      {ArmState::kDisconnected, {false, false, false, false}},
      {ArmState::kIdle, {true, false, false, false}},
      {ArmState::kMoving, {true, true, false, false}},
      {ArmState::kBraking, {true, true, true, false}},
      {ArmState::kStopped, {true, false, true, false}},
      {ArmState::kError, {true, false, true, false}},
      {ArmState::kLost, {false, false, false, true}},
      {ArmState::kLostInError, {false, false, true, true}},
  };
  for (const ArmState state : allStates()) {
    EXPECT_EQ(expected.at(state), (std::vector<bool>{isConnected(state), isInMotion(state),
                                                     isInError(state), isLost(state)}))
        << static_cast<int>(state);
  }
}

TEST(ArmState, ErrorOfAnotherThreadIsNotOverwrittenByTheEndOfAMotion) {
  for (int i = 0; i < 1000; i++) {
    ArmStateMachine machine(ArmState::kMoving);
    std::thread fails([&] { machine.handle(ArmEvent::kFailed); });
    machine.handle(ArmEvent::kMotionEnded);
    fails.join();
    ASSERT_EQ(ArmState::kError, machine.state());
  }
}

}  // namespace
}  // namespace franka_hw
