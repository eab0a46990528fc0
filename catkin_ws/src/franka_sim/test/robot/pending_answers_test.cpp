// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Answers that a control unit gives later.
#include "fci_fixture.h"
#include "robot/mode_machine.h"

namespace franka_sim::test {

namespace {

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
