// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/pid.h"

#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

using control_toolbox::Pid;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const ros::Duration kSecond(1.0);

struct Errors {
  double p, i, d;
};

Errors errorsOf(Pid& pid) {
  Errors errors;
  pid.getCurrentPIDErrors(&errors.p, &errors.i, &errors.d);
  return errors;
}

}  // namespace

TEST(Pid, ProportionalIntegralAndDerivativePartsAddUp) {
  // Computed by hand: dt 0.5, errors 2, 3, -1, gains 10, 4, 0.5, wide limits.
  Pid pid(10.0, 4.0, 0.5, 100.0, -100.0);
  const ros::Duration dt(0.5);
  EXPECT_DOUBLE_EQ(20.0 + 4.0 + 2.0, pid.computeCommand(2.0, dt));    // I 1, de 4
  EXPECT_DOUBLE_EQ(30.0 + 10.0 + 1.0, pid.computeCommand(3.0, dt));   // I 2.5, de 2
  EXPECT_DOUBLE_EQ(-10.0 + 8.0 - 4.0, pid.computeCommand(-1.0, dt));  // I 2, de -8
  EXPECT_DOUBLE_EQ(-6.0, pid.getCurrentCmd());
  const Errors errors = errorsOf(pid);
  EXPECT_DOUBLE_EQ(-1.0, errors.p);
  EXPECT_DOUBLE_EQ(2.0, errors.i);
  EXPECT_DOUBLE_EQ(-8.0, errors.d);
}

TEST(Pid, UsesAGivenDerivative) {
  Pid pid(2.0, 0.0, 3.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(2.0 * 1.5 + 3.0 * -4.0, pid.computeCommand(1.5, -4.0, kSecond));
  EXPECT_DOUBLE_EQ(-4.0, errorsOf(pid).d);
}

TEST(Pid, ResetWithStartingValues) {
  struct Case {
    double d_error, i_error, first;
  };
  for (const Case& c : {Case{0.0, 0.0, -1.0}, Case{1.0, 0.0, 0.0}, Case{0.0, -1.0, -2.0}}) {
    Pid pid(1.0, 1.0, 1.0, 5.0, -5.0);
    pid.reset(c.d_error, c.i_error);
    EXPECT_DOUBLE_EQ(c.first, pid.computeCommand(-0.5, kSecond)) << c.d_error << " " << c.i_error;
  }
  Pid pid(1.0, 1.0, 1.0, 5.0, -5.0);
  pid.reset(1.0, 0.0);
  pid.computeCommand(-0.5, kSecond);
  EXPECT_DOUBLE_EQ(-1.5, pid.computeCommand(-0.5, kSecond));
}

TEST(Pid, PlainResetTakesTheFirstDerivativeFromZero) {
  Pid pid(0.0, 0.0, 1.0, 0.0, 0.0);
  pid.computeCommand(5.0, kSecond);
  pid.reset();
  EXPECT_DOUBLE_EQ(0.0, pid.getCurrentCmd());
  EXPECT_DOUBLE_EQ(0.0, errorsOf(pid).p);
  EXPECT_DOUBLE_EQ(0.0, errorsOf(pid).i);
  EXPECT_DOUBLE_EQ(0.0, errorsOf(pid).d);
  EXPECT_DOUBLE_EQ(3.0 / 0.1, pid.computeCommand(3.0, ros::Duration(0.1)));
}

TEST(Pid, WithoutAntiwindupOnlyTheTermIsLimited) {
  Pid pid(0.0, 2.0, 0.0, 1.0, -3.0, false);
  EXPECT_DOUBLE_EQ(1.0, pid.computeCommand(4.0, kSecond));
  EXPECT_DOUBLE_EQ(4.0, errorsOf(pid).i);
  // The integral must unwind from 4 before the term leaves its limit.
  EXPECT_DOUBLE_EQ(1.0, pid.computeCommand(-3.0, kSecond));
  EXPECT_DOUBLE_EQ(-3.0, pid.computeCommand(-9.0, kSecond));
}

TEST(Pid, WithAntiwindupTheIntegralItselfIsLimited) {
  Pid pid(0.0, 2.0, 0.0, 1.0, -3.0, true);
  EXPECT_DOUBLE_EQ(1.0, pid.computeCommand(4.0, kSecond));
  EXPECT_DOUBLE_EQ(0.5, errorsOf(pid).i);
  EXPECT_DOUBLE_EQ(0.0, pid.computeCommand(-0.5, kSecond));
  EXPECT_DOUBLE_EQ(-3.0, pid.computeCommand(-9.0, kSecond));
  EXPECT_DOUBLE_EQ(-1.5, errorsOf(pid).i);
}

TEST(Pid, AntiwindupWithANegativeOrNoIntegralGain) {
  Pid negative(0.0, -2.0, 0.0, 1.0, -3.0, true);
  EXPECT_DOUBLE_EQ(-3.0, negative.computeCommand(4.0, kSecond));
  EXPECT_DOUBLE_EQ(1.5, errorsOf(negative).i);
  EXPECT_DOUBLE_EQ(1.0, negative.computeCommand(-9.0, kSecond));
  EXPECT_DOUBLE_EQ(-0.5, errorsOf(negative).i);

  Pid none(0.0, 0.0, 0.0, 1.0, -1.0, true);
  EXPECT_DOUBLE_EQ(0.0, none.computeCommand(4.0, kSecond));
  EXPECT_DOUBLE_EQ(4.0, errorsOf(none).i);
}

TEST(Pid, ZeroPeriodGivesNoCommandAndNoIntegral) {
  Pid pid(1.0, 1.0, 1.0, 5.0, -5.0);
  pid.computeCommand(2.0, kSecond);
  EXPECT_EQ(0.0, pid.computeCommand(7.0, ros::Duration(0.0)));
  EXPECT_DOUBLE_EQ(2.0, errorsOf(pid).p);  // the overload with two arguments stores nothing
  EXPECT_EQ(0.0, pid.computeCommand(7.0, 8.0, ros::Duration(0.0)));
  EXPECT_DOUBLE_EQ(7.0, errorsOf(pid).p);
  EXPECT_DOUBLE_EQ(8.0, errorsOf(pid).d);
  EXPECT_DOUBLE_EQ(2.0, errorsOf(pid).i);
  // The next derivative uses the last valid error, 2.
  EXPECT_DOUBLE_EQ(3.0 + 5.0 + 1.0, pid.computeCommand(3.0, kSecond));
}

TEST(Pid, NonFiniteInputGivesNoCommandAndKeepsTheIntegral) {
  Pid pid(1.0, 1.0, 1.0, 5.0, -5.0);
  for (const double bad : {kNan, kInf, -kInf}) {
    EXPECT_EQ(0.0, pid.computeCommand(bad, kSecond));
    EXPECT_EQ(0.0, pid.computeCommand(bad, 1.0, kSecond));
    EXPECT_EQ(0.0, pid.computeCommand(1.0, bad, kSecond));
  }
  EXPECT_DOUBLE_EQ(0.0, errorsOf(pid).i);
  EXPECT_DOUBLE_EQ(3.0, pid.computeCommand(1.0, kSecond));
}

TEST(Pid, NegativeTimeKeepsTheDerivative) {
  Pid pid(0.0, 1.0, 1.0, 50.0, -50.0);
  EXPECT_DOUBLE_EQ(2.0 + 2.0, pid.computeCommand(2.0, kSecond));
  EXPECT_DOUBLE_EQ(2.0 - 10.0 + 2.0, pid.computeCommand(10.0, ros::Duration(-1.0)));
  EXPECT_DOUBLE_EQ(-8.0 + 3.0 + 1.0, pid.computeCommand(3.0, kSecond));
}

TEST(Pid, CopiesHaveGainsButNoState) {
  Pid source(1.0, 2.0, 3.0, 4.0, -5.0, true);
  source.computeCommand(1.0, kSecond);
  Pid copy(source);
  Pid assigned;
  assigned.computeCommand(1.0, kSecond);
  assigned = source;
  for (Pid* pid : {&copy, &assigned}) {
    double p, i, d, i_max, i_min;
    bool antiwindup;
    pid->getGains(p, i, d, i_max, i_min, antiwindup);
    EXPECT_EQ(1.0, p);
    EXPECT_EQ(2.0, i);
    EXPECT_EQ(3.0, d);
    EXPECT_EQ(4.0, i_max);
    EXPECT_EQ(-5.0, i_min);
    EXPECT_TRUE(antiwindup);
    EXPECT_EQ(0.0, errorsOf(*pid).i);
    EXPECT_EQ(0.0, pid->getCurrentCmd());
  }
}

TEST(Pid, GainsChangeWithoutAReset) {
  Pid pid(1.0, 1.0, 0.0, 10.0, -10.0);
  pid.computeCommand(1.0, kSecond);
  pid.setGains(2.0, 3.0, 0.0, 10.0, -10.0);
  EXPECT_DOUBLE_EQ(2.0 + 6.0, pid.computeCommand(1.0, kSecond));
  EXPECT_TRUE(pid.trySetGains(Pid::Gains(5.0, 0.0, 0.0, 0.0, 0.0)));
  EXPECT_DOUBLE_EQ(5.0, pid.computeCommand(1.0, kSecond));
  pid.initPid(1.0, 1.0, 0.0, 10.0, -10.0);
  EXPECT_DOUBLE_EQ(2.0, pid.computeCommand(1.0, kSecond));
}

TEST(Pid, DefaultGainsAreZero) {
  Pid pid;
  EXPECT_EQ(0.0, pid.computeCommand(3.0, kSecond));
  const Pid::Gains gains = pid.getGains();
  EXPECT_EQ(0.0, gains.p_gain_ + gains.i_gain_ + gains.d_gain_ + gains.i_max_ + gains.i_min_);
  EXPECT_FALSE(gains.antiwindup_);
}

TEST(Pid, DeprecatedUpdateHasTheOppositeSign) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
  Pid pid(2.0, 0.0, 1.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(-9.0, pid.updatePid(3.0, kSecond));
  EXPECT_DOUBLE_EQ(-6.5, pid.updatePid(3.0, 0.5, kSecond));
#pragma GCC diagnostic pop
}

TEST(Pid, StepsNeitherAllocateNorLock) {
  Pid pid(1.0, 1.0, 1.0, 5.0, -5.0);
  const Pid::Gains gains(2.0, 1.0, 1.0, 5.0, -5.0);
  rt_guard::Scope scope;
  for (int i = 0; i < 100; ++i) {
    pid.computeCommand(0.1 * i, ros::Duration(0.001));
    pid.computeCommand(0.1 * i, 0.2, ros::Duration(0.001));
    pid.trySetGains(gains);
    pid.getGains();
    pid.reset();
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
  EXPECT_EQ(0u, scope.sleeps());
}

// Two threads set gains, all to one number; a step must never use a mixture.
TEST(Pid, StepsUseConsistentGainsDuringConcurrentWrites) {
  Pid pid(1.0, 1.0, 1.0, 1.0, 1.0);
  std::atomic<int> running{2};
  auto set = [&](double number) {
    for (int i = 0; i < 20000; ++i) {
      const double value = number + 2.0 * i;
      pid.setGains(value, value, value, value, value);
    }
    --running;
  };
  std::thread odd(set, 1.0);
  std::thread even(set, 2.0);
  int mixed = 0;
  do {
    const Pid::Gains gains = pid.getGains();
    const bool whole = gains.p_gain_ == gains.i_gain_ && gains.p_gain_ == gains.d_gain_ &&
                       gains.p_gain_ == gains.i_max_ && gains.p_gain_ == gains.i_min_;
    mixed += whole ? 0 : 1;
  } while (running > 0);
  odd.join();
  even.join();
  EXPECT_EQ(0, mixed);
}
