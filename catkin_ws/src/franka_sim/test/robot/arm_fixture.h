// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>
#include <gtest/gtest.h>

#include "fake_arm.h"
#include "panda_arm.h"

namespace franka_sim::test {

inline ControlUnitParameters pandaWithHand() {
  ControlUnitParameters parameters{pandaModel()};
  parameters.end_effector = pandaHand();
  parameters.F_T_NE = kHandF_T_NE;
  return parameters;
}

/// A Panda with its hand, the hand configured, in the ready pose.
class ArmTest : public ::testing::Test {
 protected:
  ArmTest() : parameters(pandaWithHand()), unit(parameters), arm(parameters.model, kReady) {
    arm.payload = parameters.end_effector;
    arm.push_frame = parameters.F_T_NE;
  }

  /// A new unit with the test's parameters.
  void rebuild() { unit = ControlUnit(parameters); }

  /// Idle, then Move under external torque control.
  void startTorqueControl() {
    tick(unit, arm);
    ASSERT_EQ(Status::kMotionStarted, unit.request(torqueControl()));
  }

  const franka_core::RobotState& run(int ticks,
                                     const franka_core::RobotCommand* command = nullptr) {
    return test::run(unit, arm, ticks, command);
  }

  ControlUnitParameters parameters;
  ControlUnit unit;
  FakeArm arm;
};

inline franka_core::RobotCommand torques(const std::array<double, 7>& tau) {
  franka_core::RobotCommand command;
  command.tau_J_d = tau;
  return command;
}

template <std::size_t N>
double norm(const std::array<double, N>& values, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; i++) {
    sum += values[i] * values[i];
  }
  return std::sqrt(sum);
}

}  // namespace franka_sim::test
