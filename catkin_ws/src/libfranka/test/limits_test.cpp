// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/rate_limiting.h>
#include <franka_core/limits.h>
#include <gtest/gtest.h>

namespace {

using franka_core::kFerLimits;
using franka_core::kFr3Limits;
using franka_core::kFr3LimitsBefore59;

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

}  // namespace
