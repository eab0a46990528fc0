// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "forward_command_controller/detail/joint_target.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

using forward_command_controller::detail::JointRange;

namespace {

JointRange revolute(double lower, double upper) {
  JointRange range;
  range.limited = true;
  range.revolute = true;
  range.lower = lower;
  range.upper = upper;
  return range;
}

/// Independent result: the shortest of all turns that end within the limits.
double shortestBySearch(double from, double to, double lower, double upper) {
  double best = std::numeric_limits<double>::infinity();
  for (int turns = -20; turns <= 20; ++turns) {
    const double way = to + 2.0 * M_PI * turns - from;
    if (from + way >= lower - 1e-12 && from + way <= upper + 1e-12 &&
        std::abs(way) < std::abs(best)) {
      best = way;
    }
  }
  return best;
}

urdf::Joint joint(int type, double lower, double upper) {
  urdf::Joint result;
  result.type = static_cast<decltype(result.type)>(type);
  result.limits = std::make_shared<urdf::JointLimits>();
  result.limits->lower = lower;
  result.limits->upper = upper;
  return result;
}

}  // namespace

TEST(JointRange, PathMatchesASearchOverAllTurns) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> limit(0.1, 12.0);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    const double lower = -limit(random);
    const double upper = limit(random);
    const double from = lower + share(random) * (upper - lower);
    const double to = lower + share(random) * (upper - lower);
    EXPECT_NEAR(shortestBySearch(from, to, lower, upper), revolute(lower, upper).way(from, to),
                1e-9)
        << lower << " " << upper << " " << from << " " << to;
  }
}

TEST(JointRange, JointOutsideItsLimitsMovesStraightBack) {
  // The shortest turn would lead from 3.01 further out and over the stop.
  EXPECT_NEAR(-6.0, revolute(-3.0, 3.0).way(3.01, -2.99), 1e-12);
  EXPECT_NEAR(6.0, revolute(-3.0, 3.0).way(-3.01, 2.99), 1e-12);
}

TEST(JointRange, ContinuousJointTakesTheShortestTurn) {
  const JointRange range(joint(urdf::Joint::CONTINUOUS, 0.0, 0.0));
  EXPECT_NEAR(0.2, range.way(3.1, 3.3 - 2.0 * M_PI), 1e-12);
  EXPECT_NEAR(-0.5, range.way(10.0 * M_PI, -0.5), 1e-12);
  EXPECT_EQ(50.0, range.clamped(50.0));
}

TEST(JointRange, PrismaticJointTakesTheDifferenceAndIsLimited) {
  const JointRange range(joint(urdf::Joint::PRISMATIC, -10.0, 8.0));
  EXPECT_EQ(17.0, range.way(-9.0, 8.0));
  EXPECT_EQ(8.0, range.clamped(9.0));
  EXPECT_EQ(-10.0, range.clamped(-11.0));
  EXPECT_EQ(1.5, range.clamped(1.5));
}

TEST(JointRange, WithoutLimitsNothingIsLimited) {
  urdf::Joint bare = joint(urdf::Joint::REVOLUTE, 0.0, 0.0);
  bare.limits.reset();
  EXPECT_EQ(7.0, JointRange(bare).clamped(7.0));
  EXPECT_EQ(7.0, JointRange(bare).way(0.0, 7.0));
}
