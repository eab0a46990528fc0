// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// ArmConnection without a robot and without ROS. Tests with both: robot/connection_test.cpp and
// robot/combined_test.cpp.
#include <franka/exception.h>
#include <franka_hw/arm_connection.h>
#include <gtest/gtest.h>

#include <memory>
#include <mutex>
#include <stdexcept>

namespace franka_hw {
namespace {

/// An owner whose robot cannot be reached.
class Owner : public ArmConnection::Owner {
 public:
  std::unique_ptr<franka::Robot> openRobot() override {
    throw franka::NetworkException("there is no robot");
  }
  void connect() override {}
  bool disconnect() override { return true; }
  franka::RobotMode robotMode() const override { return mode; }
  bool lossIsError() const override { return true; }
  void errorEnds() override {}

  franka::RobotMode mode{franka::RobotMode::kOther};
};

class ArmWithoutRobot : public testing::Test {
 protected:
  Owner owner_;
  ArmConnection arm_{owner_};
};

TEST_F(ArmWithoutRobot, IsDisconnectedAfterAFailedConnect) {
  EXPECT_THROW(arm_.connect(), franka::NetworkException);
  EXPECT_EQ(ArmState::kDisconnected, arm_.state());
  EXPECT_FALSE(arm_.robot());
}

TEST_F(ArmWithoutRobot, DisconnectsTwiceWithoutHarm) {
  EXPECT_TRUE(arm_.disconnect());
  EXPECT_TRUE(arm_.disconnect());
}

TEST_F(ArmWithoutRobot, BeginsNoMotion) {
  const ArmConnection::Motion motion(arm_);
  EXPECT_FALSE(motion);
  EXPECT_FALSE(arm_.mutex().inMotion());
}

TEST_F(ArmWithoutRobot, HasNoStateToRead) {
  franka::RobotState state;
  EXPECT_FALSE(arm_.readAtRest(state));
}

TEST_F(ArmWithoutRobot, RecoversFromNothing) { EXPECT_NO_THROW(arm_.recover()); }

TEST_F(ArmWithoutRobot, CannotRecoverFromAnErrorBeforeItIsConnected) {
  arm_.fail();
  EXPECT_TRUE(arm_.needsRecovery());
  EXPECT_THROW(arm_.recover(), franka::NetworkException);
  EXPECT_TRUE(arm_.hasOwnError());
}

TEST_F(ArmWithoutRobot, HasNoErrorAfterItWasGivenUp) {
  arm_.fail();
  EXPECT_TRUE(arm_.disconnect());
  EXPECT_FALSE(arm_.hasError());
}

TEST_F(ArmWithoutRobot, NeedsARecoveryWhenTheRobotWasStoppedAtRest) {
  for (const auto mode : {franka::RobotMode::kReflex, franka::RobotMode::kUserStopped}) {
    owner_.mode = mode;
    EXPECT_TRUE(arm_.needsRecovery());
    EXPECT_FALSE(arm_.hasError());
  }
}

TEST_F(ArmWithoutRobot, WaitingForOthersIsAnErrorButNotItsOwn) {
  EXPECT_TRUE(arm_.waitForOthers(true));
  EXPECT_FALSE(arm_.waitForOthers(true)) << "not new";
  EXPECT_TRUE(arm_.hasError());
  EXPECT_FALSE(arm_.hasOwnError());
  EXPECT_FALSE(arm_.needsRecovery());
  EXPECT_TRUE(arm_.waitForOthers(false));
  EXPECT_FALSE(arm_.hasError());
}

TEST(RobotMutex, MatchesTheState) {
  ArmStateMachine state(ArmState::kIdle);
  const RobotMutex mutex(state);
  EXPECT_FALSE(mutex.inMotion());
  state.handle(ArmEvent::kMotionStarted);
  EXPECT_TRUE(mutex.inMotion());
  state.handle(ArmEvent::kFailed);
  EXPECT_TRUE(mutex.inMotion()) << "until the motion has ended";
  state.handle(ArmEvent::kMotionEnded);
  EXPECT_FALSE(mutex.inMotion());
}

TEST(RobotMutex, IsLockedOnlyWhileTheConditionHolds) {
  const ArmStateMachine state;
  RobotMutex mutex(state);
  EXPECT_TRUE(mutex.takeWhile([] { return true; }));
  EXPECT_FALSE(mutex.takeWhile([] { return false; }));
  const std::unique_lock<std::mutex> held = mutex.take();
  int attempts = 0;
  EXPECT_FALSE(mutex.takeWhile([&] { return ++attempts < 5; }));
  EXPECT_EQ(5, attempts);
}

TEST(RobotMutex, WaitIsShort) {
  std::mutex mutex;
  const std::lock_guard<std::mutex> held(mutex);
  int attempts = 0;
  EXPECT_FALSE(RobotMutex::lockSoon(mutex, [&] { attempts++; }));
  EXPECT_GE(attempts, 1);
}

TEST(RobotMutex, ARefusalEndsTheWait) {
  std::mutex mutex;
  const std::lock_guard<std::mutex> held(mutex);
  const auto refuse = [] { throw std::runtime_error("a motion has the robot"); };
  EXPECT_THROW(RobotMutex::lockSoon(mutex, refuse), std::runtime_error);
}

TEST(RobotMutex, ReadingLoopYieldsToARequest) {
  const ArmStateMachine state;
  RobotMutex mutex(state);
  const RobotMutex::Request request(mutex);
  EXPECT_EQ(50, mutex.yieldToRequests());
}

TEST(RobotMutex, RequestForAnotherRobotIsIgnored) {
  const ArmStateMachine state;
  RobotMutex mutex(state), other(state);
  const RobotMutex::Request request(other);
  EXPECT_EQ(1, mutex.yieldToRequests());
}

}  // namespace
}  // namespace franka_hw
