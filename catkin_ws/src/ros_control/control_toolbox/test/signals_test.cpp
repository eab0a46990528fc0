// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Signals and filters, against closed forms and independent results.
#include <control_toolbox/dither.h>
#include <control_toolbox/filters.h>
#include <control_toolbox/sine_sweep.h>
#include <control_toolbox/sinusoid.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}  // namespace

TEST(Sinusoid, MatchesQuarterValuesAndDerivatives) {
  control_toolbox::Sinusoid wave(0.5, 2.0, 0.25, M_PI / 2.0);
  double qd = 0.0;
  double qdd = 0.0;
  EXPECT_NEAR(2.5, wave.update(0.0, qd, qdd), 1e-12);
  EXPECT_NEAR(0.5, wave.update(1.0, qd, qdd), 1e-12);
  EXPECT_NEAR(-1.5, wave.update(2.0, qd, qdd), 1e-12);
  const double step = 1e-4;
  for (int i = 0; i < 17; ++i) {
    const double time = -1.0 + 0.37 * i;
    double ignored[2];
    const double before = wave.update(time - step, ignored[0], ignored[1]);
    const double after = wave.update(time + step, ignored[0], ignored[1]);
    const double value = wave.update(time, qd, qdd);
    EXPECT_NEAR((after - before) / (2.0 * step), qd, 1e-7);
    EXPECT_NEAR((after - 2.0 * value + before) / (step * step), qdd, 1e-6);
  }
  EXPECT_EQ(0.0, control_toolbox::Sinusoid().update(3.0, qd, qdd));
}

// The phase is the integral of the frequency, here by Simpson's rule.
TEST(SineSweep, PhaseIsTheIntegralOfAnExponentialFrequency) {
  for (const double end : {8.0, 2.0, 0.5}) {
    control_toolbox::SineSweep sweep;
    ASSERT_TRUE(sweep.init(2.0, end, 3.0, 1.5));
    const auto frequency = [&](double time) { return 2.0 * std::pow(end / 2.0, time / 3.0); };
    const double h = 0.001;
    double turns = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double time = i * h;
      EXPECT_NEAR(1.5 * std::sin(2.0 * M_PI * turns), sweep.update(time), 1e-9);
      turns += h / 6.0 * (frequency(time) + 4.0 * frequency(time + h / 2) + frequency(time + h));
    }
    EXPECT_EQ(0.0, sweep.update(-0.001));
    EXPECT_EQ(0.0, sweep.update(3.001));
    EXPECT_EQ(0.0, sweep.update(kNotANumber));
  }
}

TEST(SineSweep, RefusesInvalidArguments) {
  control_toolbox::SineSweep sweep;
  EXPECT_EQ(0.0, sweep.update(0.1));
  for (const double bad : {0.0, -1.0, kNotANumber, kInfinity}) {
    EXPECT_FALSE(sweep.init(bad, 2.0, 1.0, 1.0));
    EXPECT_FALSE(sweep.init(1.0, bad, 1.0, 1.0));
    EXPECT_FALSE(sweep.init(1.0, 2.0, bad, 1.0));
    EXPECT_FALSE(sweep.init(1.0, 2.0, 1.0, bad));
  }
  EXPECT_EQ(0.0, sweep.update(0.1));
}

TEST(Dither, IsNormalWhiteNoise) {
  control_toolbox::Dither dither;
  EXPECT_EQ(0.0, dither.update());
  ASSERT_TRUE(dither.init(2.0, 7.0));
  constexpr int kCount = 100000;
  double sum = 0.0;
  double squares = 0.0;
  double products = 0.0;
  double last = 0.0;
  int within = 0;
  for (int i = 0; i < kCount; ++i) {
    const double value = dither.update() / 2.0;
    sum += value;
    squares += value * value;
    products += value * last;
    within += std::abs(value) < 1.0 ? 1 : 0;
    last = value;
  }
  // Five standard deviations of each estimate; the seed is fixed.
  const double five = 5.0 / std::sqrt(kCount);
  EXPECT_NEAR(0.0, sum / kCount, five);
  EXPECT_NEAR(1.0, squares / kCount, five * std::sqrt(2.0));
  EXPECT_NEAR(0.0, products / kCount, five);
  EXPECT_NEAR(std::erf(std::sqrt(0.5)), double(within) / kCount, 0.5 * five);
}

TEST(Dither, IsRepeatableAndRefusesInvalidArguments) {
  control_toolbox::Dither one;
  control_toolbox::Dither other;
  ASSERT_TRUE(one.init(1.0, 3.0));
  ASSERT_TRUE(other.init(1.0, 4.0));
  EXPECT_NE(one.update(), other.update());
  ASSERT_TRUE(other.init(1.0, 3.0));
  ASSERT_TRUE(one.init(1.0, 3.0));
  for (const double bad : {-1.0, kNotANumber, kInfinity}) {
    EXPECT_FALSE(one.init(bad, 1.0));
  }
  for (const double bad : {1e12, -1e12, kNotANumber, kInfinity}) {
    EXPECT_FALSE(one.init(1.0, bad));
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(other.update(), one.update());
  }
}

TEST(Filters, ClampKeepsToTheLimits) {
  EXPECT_EQ(2, filters::clamp(1, 2, 4));
  EXPECT_EQ(3, filters::clamp(3, 2, 4));
  EXPECT_EQ(4, filters::clamp(5, 2, 4));
  EXPECT_EQ(-0.5, control_toolbox::filters::clamp(-0.7, -0.5, 0.5));
}

TEST(Filters, SmoothingHasAGeometricStepResponse) {
  for (const double alpha : {0.0, 0.1, 0.5, 1.0}) {
    double value = 1.0;
    for (int n = 1; n <= 50; ++n) {
      value = filters::exponentialSmoothing(3.0, value, alpha);
      EXPECT_NEAR(3.0 - 2.0 * std::pow(1.0 - alpha, n), value, 1e-12);
    }
  }
}
