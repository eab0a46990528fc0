// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Answers that a control unit gives later.
#include <franka_sim/robot/pending_answers.h>

#include "fci_fixture.h"

namespace franka_sim::test {

namespace {

TEST(PendingAnswers, GivesEachAnswerOnce) {
  PendingAnswers answers;
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kRecovery));
  answers.recoveryEnds(Status::kSuccess);
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kMotion));
  EXPECT_EQ(Status::kSuccess, answers.take(PendingAnswer::kRecovery));
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kRecovery));
}

TEST(PendingAnswers, MotionAndStopWaitForRest) {
  PendingAnswers answers;
  answers.stopBegins();
  answers.motionEndsAtRest(Status::kPreempted);
  EXPECT_TRUE(answers.waitForRest());
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kMotion));
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kStop));
  answers.atRest();
  EXPECT_FALSE(answers.waitForRest());
  EXPECT_EQ(Status::kPreempted, answers.take(PendingAnswer::kMotion));
  EXPECT_EQ(Status::kSuccess, answers.take(PendingAnswer::kStop));
}

TEST(PendingAnswers, InterruptionReplacesSuccessOnly) {
  for (const Status own : {Status::kSuccess, Status::kPreempted}) {
    PendingAnswers answers;
    answers.motionEndsAtRest(own);
    answers.interruptMotion(Status::kReflexAborted);
    EXPECT_EQ(own == Status::kSuccess ? Status::kReflexAborted : own,
              answers.take(PendingAnswer::kMotion));
    EXPECT_FALSE(answers.waitForRest());
  }
}

TEST(PendingAnswers, StopIsInterruptedOnlyWhileItWaits) {
  PendingAnswers answers;
  answers.interruptStop(Status::kReflexAborted);
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kStop));
  answers.stopBegins();
  answers.interruptStop(Status::kReflexAborted);
  answers.atRest();
  EXPECT_EQ(Status::kReflexAborted, answers.take(PendingAnswer::kStop));
}

}  // namespace

}  // namespace franka_sim::test
