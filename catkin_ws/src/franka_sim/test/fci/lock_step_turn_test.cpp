// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/lock_step_turn.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>

#include <chrono>
#include <optional>
#include <string>

#include "own_directory.h"

namespace franka_sim::fci {

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kTick{1};

class LockStepTurnTest : public ::testing::Test {
 protected:
  static bool isWoken(const LockStepTurn& turn) {
    pollfd descriptor{turn.descriptor(), POLLIN, 0};
    return poll(&descriptor, 1, 0) == 1;
  }

  /// Asks until the turn may go on. @returns how long that took.
  LockStepTurn::Clock::duration wait(LockStepTurn& turn) {
    const auto begin = now;
    while (!turn.take(now)) {
      now += turn.retryAfter(now);
    }
    return now - begin;
  }

  const OwnDirectory own;
  const std::string& directory{own.path()};
  const std::string name{"test"};
  LockStepTurn::Clock::time_point now{seconds(1000)};
  LockStepTurn one{directory, name, 1}, other{directory, name, 1}, third{directory, name, 1};
};

TEST_F(LockStepTurnTest, AsManyHaveATurnAsThereArePlaces) {
  LockStepTurn a(directory, name, 2), b(directory, name, 2), c(directory, name, 2);
  EXPECT_TRUE(a.take(now));
  EXPECT_TRUE(b.take(now));
  EXPECT_FALSE(c.take(now));
  b.give();
  EXPECT_TRUE(c.take(now));
  EXPECT_FALSE(b.take(now));
  LockStepTurn of_other_processors(directory, name + "2", 1);
  EXPECT_TRUE(of_other_processors.take(now));
}

TEST_F(LockStepTurnTest, WithoutPlacesNobodyWaits) {
  LockStepTurn a(directory, name, 0), b(directory, name, 0);
  EXPECT_TRUE(a.take(now));
  EXPECT_TRUE(b.take(now));
  EXPECT_FALSE(b.taken());
}

TEST_F(LockStepTurnTest, WhereOthersMayWriteNobodyWaits) {
  EXPECT_TRUE(one.take(now));
  ASSERT_EQ(0, chmod(directory.c_str(), 0777));
  LockStepTurn a(directory, name, 1), b("/", name, 1), c(directory + "/none", name, 1);
  for (LockStepTurn* turn : {&a, &b, &c}) {
    EXPECT_TRUE(turn->take(now));
    EXPECT_FALSE(turn->taken());
  }
}

TEST_F(LockStepTurnTest, LastsAsLongAsNobodyWaits) {
  for (int i = 0; i < 1000; i++) {
    ASSERT_TRUE(one.take(now));
    ASSERT_TRUE(one.taken());
    now += kTick;
  }
}

TEST_F(LockStepTurnTest, GoesToTheProcessThatWaits) {
  EXPECT_TRUE(one.take(now));
  EXPECT_FALSE(other.take(now));
  now += LockStepTurn::kLength - kTick;
  EXPECT_TRUE(one.take(now));
  EXPECT_FALSE(isWoken(other));
  now += kTick;
  EXPECT_FALSE(one.take(now));
  EXPECT_TRUE(isWoken(other));
  EXPECT_TRUE(other.take(now));
  EXPECT_FALSE(one.take(now));
  now += LockStepTurn::kLength;
  EXPECT_FALSE(other.take(now));
  EXPECT_TRUE(one.take(now));
}

TEST_F(LockStepTurnTest, WhoHasWaitedForLongLooksMoreOften) {
  EXPECT_TRUE(one.take(now));
  EXPECT_FALSE(other.take(now));
  EXPECT_FALSE(third.take(now));
  EXPECT_EQ(-1, third.descriptor()) << "not the first in the queue";
  const auto at_first = third.retryAfter(now);
  now += 3 * LockStepTurn::kLength;
  EXPECT_LT(third.retryAfter(now), at_first);
  EXPECT_GE(third.retryAfter(now), LockStepTurn::kMinRetry);
}

TEST_F(LockStepTurnTest, EndsWithItsProcess) {
  std::optional<LockStepTurn> ended(std::in_place, directory, name, 1);
  EXPECT_TRUE(ended->take(now));
  EXPECT_FALSE(one.take(now));    // first in the queue
  EXPECT_FALSE(other.take(now));  // second
  ended.reset();
  EXPECT_TRUE(one.take(now));
  one.give();
  EXPECT_TRUE(other.take(now));
}

TEST_F(LockStepTurnTest, NobodyWaitsForLongForAStoppedProcess) {
  EXPECT_TRUE(one.take(now));  // and never gives it back
  EXPECT_NEAR(wait(other).count(), milliseconds(LockStepTurn::kMaxWait).count() * 1e6,
              milliseconds(LockStepTurn::kMaxRetry).count() * 1e6);
  EXPECT_FALSE(other.taken());
  now += LockStepTurn::kLength;
  EXPECT_GE(wait(other), LockStepTurn::kMaxWait) << "the queue may only have been long";
  for (const auto end = now + LockStepTurn::kWithoutTurn - kTick; now < end; now += kTick) {
    ASSERT_TRUE(other.take(now));
  }
  EXPECT_TRUE(third.take(now) || third.descriptor() >= 0) << "it still holds up the queue";
}

TEST_F(LockStepTurnTest, ASlowClientsProcessNeedsNoTurn) {
  for (int i = 0; i < LockStepTurn::kSlowAnswers; i++) {
    EXPECT_TRUE(one.take(now));
    EXPECT_TRUE(one.taken());
    one.giveForSilence(now);
    EXPECT_FALSE(one.taken());
  }
  EXPECT_TRUE(one.take(now));
  EXPECT_FALSE(one.taken());
  EXPECT_TRUE(other.take(now));
  EXPECT_TRUE(other.taken());
  other.give();
  now += LockStepTurn::kSlowClient;
  EXPECT_TRUE(one.take(now));
  EXPECT_TRUE(one.taken());
}

TEST_F(LockStepTurnTest, AQuickAnswerBetweenSlowOnesKeepsTurns) {
  for (int i = 0; i < 3 * LockStepTurn::kSlowAnswers; i++) {
    EXPECT_TRUE(one.take(now));
    ASSERT_TRUE(one.taken());
    if (i % 2 == 0) {
      one.giveForSilence(now);
    }
  }
}

}  // namespace

}  // namespace franka_sim::fci
