// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/motion_limits.h>
#include <gtest/gtest.h>

#include "../support/arrays.h"
#include "fake_arm.h"
#include "panda_arm.h"

namespace franka_sim::test {

inline ControlUnitParameters pandaWithHand() {
  ControlUnitParameters parameters{pandaModel()};
  parameters.end_effector = pandaHand();
  parameters.F_T_NE = kHandF_T_NE;
  return parameters;
}

/// The same behind the FCI.
inline ControlUnitParameters pandaOverFci(unsigned protocol_version = 5) {
  ControlUnitParameters parameters = pandaWithHand();
  parameters.rules = InterfaceRules::kFci;
  parameters.protocol_version = protocol_version;
  return parameters;
}

inline franka_core::fci::MoveRequest moveRequest(
    franka_core::MotionGeneratorMode generator,
    franka_core::ControllerMode controller = franka_core::ControllerMode::kJointImpedance) {
  franka_core::fci::MoveRequest request;
  request.motion_generator_mode = generator;
  request.controller_mode = controller;
  return request;
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

}  // namespace franka_sim::test
