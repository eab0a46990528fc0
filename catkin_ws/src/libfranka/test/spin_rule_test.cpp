// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// When a wait goes without sleep, with a clock that the test moves.
#include <franka_core/spin_rule.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

namespace {

using franka_core::SpinRule;
using franka_core::toWaitMode;
using franka_core::WaitMode;
using franka_core::waitModeOfEnvironment;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Duration = SpinRule::Clock::duration;

constexpr Duration kLook = microseconds(1);
constexpr Duration kNever = seconds(1000);

/// A thread that works for a while, then waits for an answer that takes a while, then works again.
class SpinRuleTest : public ::testing::Test {
 protected:
  /// One wait. @param answer the time until it comes. @param interruption time in which this thread
  /// does not run although it does not sleep, in the middle of the wait.
  /// @returns whether the answer came without sleep.
  bool wait(SpinRule& rule, Duration answer, Duration interruption = {}) {
    now_ += microseconds(20);
    const auto answered_at = now_ + answer;
    looks_ = 0;
    const auto look = [&] {
      looks_++;
      now_ += kLook + (looks_ == 3 ? interruption : Duration{});
      return now_ >= answered_at;
    };
    const auto begin = now_;
    const bool answered = rule.spin(look, [this] { return now_; });
    spun_ = now_ - begin;
    if (!answered && answer < kNever) {
      now_ = std::max(now_, answered_at) + microseconds(50);  // asleep, then woken up
    }
    return answered;
  }

  /// The share of the waits of this time that began without sleep. @param every only every so many
  /// waits are interrupted.
  double shareOfSpins(SpinRule& rule, Duration time, Duration answer, Duration interruption = {},
                      int every = 1) {
    int waits = 0;
    int spins = 0;
    for (const auto end = now_ + time; now_ < end; waits++) {
      wait(rule, answer, waits % every == 0 ? interruption : Duration{});
      spins += looks_ > 0 ? 1 : 0;
    }
    return static_cast<double>(spins) / waits;
  }

  SpinRule::Clock::time_point now_{seconds(5)};
  int looks_{0};
  Duration spun_{};
};

TEST_F(SpinRuleTest, BlockNeverLooks) {
  for (SpinRule rule : {SpinRule(WaitMode::kBlock, true), SpinRule(WaitMode::kAuto, false),
                        SpinRule(WaitMode::kSpin, false)}) {
    EXPECT_FALSE(wait(rule, microseconds(5)));
    EXPECT_EQ(0, looks_);
    EXPECT_EQ(WaitMode::kBlock, rule.mode());
  }
}

TEST_F(SpinRuleTest, AWaitWithoutSleepHasALimit) {
  for (WaitMode mode : {WaitMode::kSpin, WaitMode::kAuto}) {
    SpinRule rule(mode, true);
    EXPECT_FALSE(wait(rule, seconds(1)));
    EXPECT_GE(spun_, SpinRule::kMaxSpin);
    EXPECT_LE(spun_, SpinRule::kMaxSpin + 2 * kLook);
    EXPECT_TRUE(wait(rule, microseconds(150)));
    EXPECT_TRUE(wait(rule, {}));
    EXPECT_EQ(1, looks_);
  }
}

TEST_F(SpinRuleTest, SleepsWhereAnswersAreSlowOrTheMachineIsBusy) {
  const SpinRule spin(WaitMode::kSpin, true), rule(WaitMode::kAuto, true);
  const SpinRule with_gap(WaitMode::kAuto, true, microseconds(300));
  const struct {
    const SpinRule& rule;
    Duration time, answer, interruption;
    int every;
    double lowest, highest;  // share of the waits without sleep
  } rows[] = {
      {spin, seconds(1), milliseconds(3), {}, 1, 1.0, 1.0},
      {spin, seconds(1), microseconds(10), milliseconds(3), 1, 1.0, 1.0},
      {rule, seconds(10), microseconds(5), {}, 1, 1.0, 1.0},
      {rule, seconds(10), microseconds(150), {}, 1, 1.0, 1.0},
      {rule, seconds(10), microseconds(300), {}, 1, 0.0, 0.05},
      {rule, seconds(10), milliseconds(1), {}, 1, 0.0, 0.05},
      // Five waits, then the longest pause, of 2 s.
      {rule, seconds(100), milliseconds(30), {}, 1, 0.0, 5.0 / (2000.0 / 30.0)},
      // Each time slice of 3 ms another thread runs for as long.
      {rule, seconds(10), microseconds(10), milliseconds(3), 100, 0.0, 0.05},
      {with_gap, seconds(10), microseconds(10), milliseconds(3), 100, 0.0, 0.05},
      // Interruptions shorter than the gap, and threads that need little.
      {with_gap, seconds(10), microseconds(10), microseconds(150), 1, 1.0, 1.0},
      {rule, seconds(10), microseconds(10), microseconds(100), 30, 1.0, 1.0},
  };
  for (const auto& row : rows) {
    SpinRule fresh = row.rule;
    const double share = shareOfSpins(fresh, row.time, row.answer, row.interruption, row.every);
    EXPECT_LE(row.lowest, share) << &row - rows;
    EXPECT_GE(row.highest, share) << &row - rows;
  }
}

TEST_F(SpinRuleTest, SaysHowLongItPauses) {
  SpinRule rule(WaitMode::kAuto, true);
  EXPECT_EQ(Duration{}, rule.pauseLeft(now_));
  for (int i = 0; i < 5; i++) {
    wait(rule, kNever);
  }
  const Duration left = rule.pauseLeft(now_);
  EXPECT_GE(left, 32 * 5 * SpinRule::kMaxSpin);
  EXPECT_EQ(milliseconds(5), left - rule.pauseLeft(now_ + milliseconds(5)));
  EXPECT_EQ(Duration{}, rule.pauseLeft(now_ + left));
}

// As at the begin of each motion.
TEST_F(SpinRuleTest, SingleWaitsWithoutAnAnswerDoNotEndIt) {
  SpinRule rule(WaitMode::kAuto, true);
  for (int i = 0; i < 1000; i++) {
    wait(rule, milliseconds(5));
    for (int k = 0; k < 1000; k++) {
      ASSERT_TRUE(wait(rule, microseconds(20))) << i << " " << k;
    }
  }
}

TEST_F(SpinRuleTest, ItIsTriedAgainWithinTwoSeconds) {
  SpinRule rule(WaitMode::kAuto, true);
  shareOfSpins(rule, seconds(60), milliseconds(40));
  shareOfSpins(rule, milliseconds(2001), microseconds(20));
  EXPECT_EQ(1.0, shareOfSpins(rule, seconds(1), microseconds(20)));
}

TEST_F(SpinRuleTest, TimeOutsideTheExchangeDoesNotCount) {
  SpinRule rule(WaitMode::kAuto, true);
  for (int i = 0; i < 100; i++) {
    EXPECT_TRUE(wait(rule, microseconds(20))) << i;
    now_ += seconds(100);  // the program does something else
  }
}

TEST(WaitMode, HasThreeNames) {
  EXPECT_EQ(WaitMode::kAuto, toWaitMode("auto"));
  EXPECT_EQ(WaitMode::kSpin, toWaitMode("spin"));
  EXPECT_EQ(WaitMode::kBlock, toWaitMode("block"));
  for (const char* wrong : {"", "Auto", "spin ", "blocks", "0"}) {
    EXPECT_FALSE(toWaitMode(wrong)) << wrong;
  }
}

class WaitVariable : public ::testing::Test {
 protected:
  WaitVariable() { unsetenv("FRANKA_WAIT"); }
  ~WaitVariable() override { unsetenv("FRANKA_WAIT"); }
};

TEST_F(WaitVariable, NamesAModeOrIsRefused) {
  EXPECT_EQ(WaitMode::kAuto, waitModeOfEnvironment());
  setenv("FRANKA_WAIT", "", 1);
  EXPECT_EQ(WaitMode::kAuto, waitModeOfEnvironment());
  setenv("FRANKA_WAIT", "block", 1);
  EXPECT_EQ(WaitMode::kBlock, waitModeOfEnvironment());
  setenv("FRANKA_WAIT", "sleep", 1);
  EXPECT_THROW(waitModeOfEnvironment(), std::invalid_argument);
}

}  // namespace
