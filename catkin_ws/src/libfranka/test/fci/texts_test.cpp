// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/texts.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

using namespace franka_core::fci;  // NOLINT: the whole vocabulary of replies
using franka_core::RobotMode;

// Word for word as users and programs know them.
TEST(Texts, MatchTheGenuineClient) {
  struct Case {
    Command command;
    Status status;
    RobotMode mode;
    const char* text;
  };
  const Case cases[] = {
      {Command::kMove, Status::kCommandNotPossibleRejected, RobotMode::kIdle,
       "libfranka: Move command rejected: command not possible in the current mode (\"Idle\")!"},
      {Command::kMove, Status::kCommandNotPossibleRejected, RobotMode::kOther,
       "libfranka: Move command rejected: command not possible in the current mode (\"Other\")! "
       "Did you open the brakes?"},
      {Command::kSetLoad, Status::kCommandNotPossibleRejected, RobotMode::kUserStopped,
       "libfranka: Set Load command rejected: command not possible in the current mode (\"User "
       "stopped\")!"},
      {Command::kStopMove, Status::kAborted, RobotMode::kAutomaticErrorRecovery,
       "libfranka: Stop Move command rejected: command not possible in the current mode "
       "(\"Automatic error recovery\")!"},
      {Command::kSetEEToK, Status::kInvalidArgumentRejected, RobotMode::kIdle,
       "libfranka: Set EE to K command rejected: invalid argument!"},
      {Command::kMove, Status::kInvalidArgumentRejected, RobotMode::kIdle,
       "libfranka: Move command rejected: maximum path deviation out of range!"},
      {Command::kMove, Status::kStartAtSingularPoseRejected, RobotMode::kIdle,
       "libfranka: Move command rejected: cannot start at singular pose!"},
      {Command::kMove, Status::kPreempted, RobotMode::kIdle, "libfranka: Move command preempted!"},
      {Command::kMove, Status::kReflexAborted, RobotMode::kReflex,
       "libfranka: Move command aborted: motion aborted by reflex!"},
      {Command::kStopMove, Status::kEmergencyAborted, RobotMode::kUserStopped,
       "libfranka: Stop Move command aborted: User Stop pressed!"},
      {Command::kMove, Status::kInputErrorAborted, RobotMode::kReflex,
       "libfranka: Move command aborted: invalid input provided!"},
      {Command::kAutomaticErrorRecovery, Status::kAborted, RobotMode::kReflex,
       "libfranka: Automatic Error Recovery command aborted!"},
      {Command::kAutomaticErrorRecovery, Status::kManualErrorRecoveryRequiredRejected,
       RobotMode::kReflex,
       "libfranka: Automatic Error Recovery command rejected: manual error recovery required!"},
      {Command::kMove, Status::kPreemptedDueToActivatedSafetyFunctions, RobotMode::kMove,
       "libfranka: Move command preempted due to activated safety function! Please disable all "
       "safety functions."},
      {Command::kMove, Status::kRejectedDueToActivatedSafetyFunctions, RobotMode::kMove,
       "libfranka: Move command rejected due to activated safety function! Please disable all "
       "safety functions."},
      {Command::kSetNEToEE, Status::kRejectedDueToActivatedSafetyFunctions, RobotMode::kMove,
       "libfranka: Set NE to EE command rejected due to activated safety function! Please disable "
       "all safety functions. "},
      {Command::kGetRobotModel, Status::kSuccess, RobotMode::kIdle,
       "libfranka: Unexpected response while handling Get Robot Model command!"},
  };
  for (const Case& test : cases) {
    EXPECT_EQ(statusText(test.command, test.status, test.mode), test.text);
  }
}

TEST(Texts, DistinguishGoodRejectedAndAborted) {
  EXPECT_EQ(meaning(Status::kSuccess), Meaning::kGood);
  EXPECT_EQ(meaning(Status::kMotionStarted), Meaning::kGood);
  EXPECT_EQ(meaning(Status::kPreempted), Meaning::kAborted);
  EXPECT_EQ(meaning(Status::kEmergencyAborted), Meaning::kAborted);
  EXPECT_EQ(meaning(Status::kInvalidArgumentRejected), Meaning::kRejected);
  EXPECT_EQ(meaning(Status::kIncompatibleLibraryVersion), Meaning::kRejected);
}

TEST(Texts, NameEachModeAndCommandOnce) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kCommandCount; i++) {
    names.insert(commandName(static_cast<Command>(i)));
  }
  EXPECT_EQ(names.size(), kCommandCount);
  std::set<std::string> modes;
  for (int i = 0; i <= 6; i++) {
    modes.insert(modeName(static_cast<RobotMode>(i)));
  }
  EXPECT_EQ(modes.size(), 7U);
}

TEST(CodecErrors, AreDifferentSentences) {
  std::set<std::string> sentences;
  for (int i = 0; i <= static_cast<int>(CodecError::kNotFinite); i++) {
    const std::string text = describe(static_cast<CodecError>(i));
    EXPECT_EQ(text.back(), '.') << text;
    sentences.insert(text);
  }
  EXPECT_EQ(sentences.size(), 11U);
}

TEST(CodecErrors, NameBothSizes) {
  EXPECT_EQ(sentence(CodecError::kWrongSize, "robot state of protocol version 5", 1377, 2373),
            "Cannot use the robot state of protocol version 5 (1377 bytes where 2373 are due): The "
            "message does not have the size that this protocol version gives it.");
  EXPECT_EQ(sentence(CodecError::kUnknownEnum, "robot state", 1377, 1377),
            "Cannot use the robot state (1377 bytes): The message carries a mode or choice that "
            "does not exist.");
}

}  // namespace
