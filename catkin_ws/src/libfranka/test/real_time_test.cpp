// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Functions for the 1 kHz loop neither allocate nor lock.
#include <franka/lowpass_filter.h>
#include <franka/rate_limiting.h>
#include <franka_core/to_franka.h>
#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include <cmath>

#include "random_state.h"

namespace franka_test {
namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;

TEST(RealTime, ArmModelNeitherAllocatesNorLocks) {
  const ArmModel arm = ArmModel::fromUrdf(readData("panda_hand.urdf"));
  const State s = StateSource(franka_core::kFerLimits).next();
  franka_core::ArmDynamics dynamics;
  double sum = 0.0;
  rt_guard::Scope scope;
  for (int f = 0; f < 10; f++) {
    const auto frame = static_cast<ArmFrame>(f);
    sum += arm.pose(frame, s.q, s.F_T_EE, s.EE_T_K)[12];
    sum += arm.zeroJacobian(frame, s.q, s.F_T_EE, s.EE_T_K)[0];
    sum += arm.bodyJacobian(frame, s.q, s.F_T_EE, s.EE_T_K)[0];
    arm.computeDynamics(frame, s.q, s.dq, s.F_T_EE, s.EE_T_K, s.payload, s.gravity_earth, dynamics);
  }
  sum += arm.mass(s.q, s.payload)[0] + arm.coriolis(s.q, s.dq, s.payload)[0];
  sum += arm.gravity(s.q, s.payload)[0] + arm.inverseDynamics(s.q, s.dq, s.ddq, s.payload)[0];
  sum += combine(s.payload, s.payload).mass + dynamics.mass[0];
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(RealTime, StatesFiltersAndLimitsNeitherAllocateNorLock) {
  franka_core::RobotState from;
  franka::RobotState to;
  const State s = StateSource(franka_core::kFerLimits).next();
  rt_guard::Scope scope;
  franka_core::toFranka(from, to);
  const franka::RobotState copy = to;
  const auto pose = franka::cartesianLowpassFilter(franka::kDeltaT, s.F_T_EE, s.EE_T_K, 100.0);
  const auto limited = franka::limitRate(1.0, 10.0, 1000.0, 1.0, 10.0, 1000.0, pose, s.F_T_EE,
                                         std::array<double, 6>{}, std::array<double, 6>{});
  const auto torques = franka::limitRate(franka::kMaxTorqueRate, s.q, s.dq);
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
  EXPECT_TRUE(std::isfinite(limited[0] + torques[0] + copy.q[0]));
}

}  // namespace
}  // namespace franka_test
