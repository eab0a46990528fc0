// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/rate_limiting.h>
#include <franka_core/limits.h>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using franka_core::ArmLimits;
using franka_core::kFerLimits;
using franka_core::kFr3Limits;
using franka_core::kFr3LimitsBefore59;
using franka_core::kFr3PositionVelocityLimits;

TEST(Limits, LowerBoundsAreBelowUpperBounds) {
  for (const ArmLimits* limits : {&kFerLimits, &kFr3Limits, &kFr3LimitsBefore59}) {
    for (std::size_t i = 0; i < 7; i++) {
      EXPECT_LT(limits->q_min[i], limits->q_max[i]);
      EXPECT_GE(limits->dq[i], limits->rate_limiter_dq[i]);
      EXPECT_EQ(i < 4 ? 87.0 : 12.0, limits->tau[i]);
    }
  }
}

// FR3's ranges grew with system 5.9, in every joint.
TEST(Limits, RangesOfAnFr3GrowWithSystem59) {
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_LE(kFr3Limits.q_min[i], kFr3LimitsBefore59.q_min[i]);
    EXPECT_GE(kFr3Limits.q_max[i], kFr3LimitsBefore59.q_max[i]);
  }
}

TEST(Limits, DependOnTheProtocol) {
  EXPECT_EQ(&kFerLimits, &franka_core::limitsOfProtocol(3));
  EXPECT_EQ(&kFerLimits, &franka_core::limitsOfProtocol(5));
  EXPECT_EQ(&kFr3LimitsBefore59, &franka_core::limitsOfProtocol(6));
  EXPECT_EQ(&kFr3LimitsBefore59, &franka_core::limitsOfProtocol(9));
  EXPECT_EQ(&kFr3Limits, &franka_core::limitsOfProtocol(10));
}

// Computed by hand from the published rule: L - 0.001, V - 0.001 - 3 * 0.001 * (A - 0.001).
TEST(Limits, ClientLimitsHaveAMargin) {
  EXPECT_DOUBLE_EQ(999.999, franka::kMaxTorqueRate[6]);
  EXPECT_DOUBLE_EQ(3749.999, franka::kMaxJointJerk[1]);
  EXPECT_DOUBLE_EQ(14.999, franka::kMaxJointAcceleration[0]);
  EXPECT_DOUBLE_EQ(2.129003, franka::kMaxJointVelocity[0]);
  EXPECT_DOUBLE_EQ(2.549003, franka::kMaxJointVelocity[6]);
  EXPECT_DOUBLE_EQ(1.960003, franka::kMaxTranslationalVelocity);
  EXPECT_DOUBLE_EQ(12.999, franka::kMaxTranslationalAcceleration);
  EXPECT_DOUBLE_EQ(6499.999, franka::kMaxTranslationalJerk);
  EXPECT_DOUBLE_EQ(2.424003, franka::kMaxRotationalVelocity);
  EXPECT_DOUBLE_EQ(24.999, franka::kMaxRotationalAcceleration);
  EXPECT_DOUBLE_EQ(12499.999, franka::kMaxRotationalJerk);
  EXPECT_DOUBLE_EQ(2.144003, franka::kMaxElbowVelocity);
  EXPECT_DOUBLE_EQ(9.999, franka::kMaxElbowAcceleration);
  EXPECT_DOUBLE_EQ(4999.999, franka::kMaxElbowJerk);
}

TEST(Limits, VelocityShrinksTowardsTheEnds) {
  const auto& limits = kFr3PositionVelocityLimits;
  EXPECT_EQ(2.62, upperVelocityLimit(limits, 0, 0.0));
  EXPECT_EQ(-2.62, lowerVelocityLimit(limits, 0, 0.0));
  EXPECT_EQ(0.0, upperVelocityLimit(limits, 0, 2.7501));
  EXPECT_EQ(0.0, upperVelocityLimit(limits, 0, 3.0));
  EXPECT_EQ(0.0, lowerVelocityLimit(limits, 0, -3.0));
  // A tenth of a radian before the end: sqrt(12 * 0.1) - 0.3.
  EXPECT_NEAR(0.795445115010332, upperVelocityLimit(limits, 0, 2.6501), 1e-12);
  EXPECT_NEAR(-0.795445115010332, lowerVelocityLimit(limits, 0, -2.6501), 1e-12);
  EXPECT_EQ(-2.62, lowerVelocityLimit(limits, 0, 2.6501));
}

}  // namespace
