// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The limiter for the connected robot: for any desired motion the output stays within that robot's
// limits (franka_core/limits.h). Tests of the simulated robot show that it never aborts such a
// motion.
#include "franka/arm_rate_limits.h"

#include <franka/rate_limiting.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace {

using franka::ArmRateLimits;
using franka::kDeltaT;
using Joints = ArmRateLimits::Joints;

// Rounding of a difference quotient over 1 ms: of positions below 4 rad, of velocities.
constexpr double kVelocityRounding = 1e-11;
constexpr double kAccelerationRounding = 1e-8;

class RobotOfVersion : public ::testing::TestWithParam<std::uint16_t> {
 protected:
  RobotOfVersion() : limits_(franka::rateLimitsOfProtocol(GetParam())) {}

  const franka_core::ArmLimits& arm() const { return franka_core::limitsOfProtocol(GetParam()); }
  bool isFr3() const { return GetParam() > 5; }

  /// The robot's own limit at q, without margin.
  double highest(std::size_t joint, double q) const {
    return limits_.position_velocity
               ? franka_core::upperVelocityLimit(*limits_.position_velocity, joint, q)
               : arm().dq[joint];
  }
  double lowest(std::size_t joint, double q) const {
    return limits_.position_velocity
               ? franka_core::lowerVelocityLimit(*limits_.position_velocity, joint, q)
               : -arm().dq[joint];
  }

  Joints middle() const {
    Joints q{};
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = (arm().q_min[i] + arm().q_max[i]) / 2.0;
    }
    return q;
  }

  /// A random target at some ticks: rest, small, or far too large.
  Joints randomTarget(double scale) {
    std::uniform_real_distribution<double> anything(-scale, scale);
    Joints result{};
    for (double& value : result) {
      const double share = anything(random_) / scale;
      value = share < -0.5 ? 0.0 : share < 0.0 ? 0.05 * anything(random_) : 3.0 * anything(random_);
    }
    return result;
  }

  const ArmRateLimits limits_;
  std::mt19937 random_{GetParam()};
};

TEST_P(RobotOfVersion, VelocitiesStayWithinAllLimits) {
  Joints q = middle(), v{}, a{}, desired{};
  Joints fastest{};
  for (int k = 0; k < 40000; k++) {
    if (k % 900 == 0) {
      desired = randomTarget(3.0);
    }
    const Joints next = limits_.limitVelocities(q, desired, v, a);
    for (std::size_t i = 0; i < 7; i++) {
      const double next_a = (next[i] - v[i]) / kDeltaT;
      const double next_q = q[i] + next[i] * kDeltaT;
      EXPECT_LE(next[i], highest(i, next_q) + kVelocityRounding) << i << " at " << k;
      EXPECT_GE(next[i], lowest(i, next_q) - kVelocityRounding) << i << " at " << k;
      EXPECT_LE(std::abs(next_a), arm().ddq[i] + kAccelerationRounding) << i << " at " << k;
      EXPECT_LE(std::abs(next_a - a[i]) / kDeltaT, arm().dddq[i] + 1e-4) << i << " at " << k;
      fastest[i] = std::max(fastest[i], std::abs(next[i]));
      a[i] = next_a;
      v[i] = next[i];
      // The Panda's limiter ignores positions.
      q[i] = isFr3() ? next_q : std::clamp(next_q, arm().q_min[i], arm().q_max[i]);
    }
  }
  // Detects a limiter that is too strict, too.
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_GT(fastest[i], 0.8 * std::min(arm().dq[i], highest(i, middle()[i]))) << i;
  }
}

TEST_P(RobotOfVersion, PositionsAreLimitedLikeVelocities) {
  Joints q = middle(), v{}, a{}, desired = q;
  for (int k = 0; k < 5000; k++) {
    if (k % 250 == 0) {
      const Joints away = randomTarget(1.0);
      for (std::size_t i = 0; i < 7; i++) {
        desired[i] = q[i] + away[i];
      }
    }
    Joints desired_velocity{};
    for (std::size_t i = 0; i < 7; i++) {
      desired_velocity[i] = (desired[i] - q[i]) / kDeltaT;
    }
    const Joints velocities = limits_.limitVelocities(q, desired_velocity, v, a);
    const Joints next = limits_.limitPositions(desired, q, v, a);
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_DOUBLE_EQ(q[i] + kDeltaT * velocities[i], next[i]);
      a[i] = (velocities[i] - v[i]) / kDeltaT;
      v[i] = velocities[i];
      q[i] = next[i];
    }
  }
}

TEST_P(RobotOfVersion, OtherLimitsAreThoseOfTheRobotWithAMargin) {
  using franka_core::DerivativeLimits;
  const std::pair<DerivativeLimits, DerivativeLimits> pairs[] = {
      {limits_.translation, arm().translation},
      {limits_.rotation, arm().rotation},
      {limits_.elbow, arm().elbow}};
  for (const auto& [limiter, robot] : pairs) {
    EXPECT_LT(limiter.velocity, robot.velocity);
    EXPECT_GT(limiter.velocity, 0.95 * robot.velocity);
    EXPECT_NEAR(robot.acceleration - 1e-3, limiter.acceleration, 1e-9);
    EXPECT_NEAR(robot.jerk - 1e-3, limiter.jerk, 1e-9);
  }
  EXPECT_NEAR(1000.0 - 1e-3, limits_.torque_rate[6], 1e-9);
}

// The classic limiter knows no limits that depend on the position, as an FR3 has.
class PandaOfVersion : public RobotOfVersion {};

TEST_P(PandaOfVersion, AgreesWithTheClassicLimiter) {
  Joints q = middle(), v{}, a{}, desired{};
  for (int k = 0; k < 20000; k++) {
    if (k % 300 == 0) {
      desired = randomTarget(3.0);
    }
    const Joints next = limits_.limitVelocities(q, desired, v, a);
    EXPECT_EQ(franka::limitRate(franka::kMaxJointVelocity, franka::kMaxJointAcceleration,
                                franka::kMaxJointJerk, desired, v, a),
              next);
    for (std::size_t i = 0; i < 7; i++) {
      a[i] = (next[i] - v[i]) / kDeltaT;
      v[i] = next[i];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, RobotOfVersion, ::testing::Values(3, 5, 6, 9, 10),
                         [](const auto& info) { return "Version" + std::to_string(info.param); });
INSTANTIATE_TEST_SUITE_P(All, PandaOfVersion, ::testing::Values(3, 5),
                         [](const auto& info) { return "Version" + std::to_string(info.param); });

}  // namespace
