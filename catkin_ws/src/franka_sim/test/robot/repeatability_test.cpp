// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The same inputs give the same bits, and a tick neither allocates nor locks.
#include <rt_guard/rt_guard.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <vector>

#include "arm_fixture.h"
#include "fake_hand.h"

namespace franka_sim::test {

namespace {

/// All bits of the joint-space fields, poses and wrenches of a state.
void append(std::vector<double>& log, const franka_core::RobotState& s) {
  for (const auto* field : {&s.tau_J, &s.tau_J_d, &s.dtau_J, &s.q, &s.q_d, &s.dq, &s.theta,
                            &s.dtheta, &s.tau_ext_hat_filtered}) {
    log.insert(log.end(), field->begin(), field->end());
  }
  log.insert(log.end(), s.O_T_EE.begin(), s.O_T_EE.end());
  log.insert(log.end(), s.O_F_ext_hat_K.begin(), s.O_F_ext_hat_K.end());
  log.insert(log.end(), s.K_F_ext_hat_K.begin(), s.K_F_ext_hat_K.end());
  log.push_back(static_cast<double>(s.robot_mode));
  log.push_back(s.control_command_success_rate);
}

/// Runs a scenario twice: the same bits, and neither a tick nor a request allocates or locks.
/// @param scenario appends to a log and adds up what the real-time guard counts
void expectRepeatableAndRealTimeSafe(
    const std::function<void(std::vector<double>& log, std::size_t& dirty)>& scenario) {
  std::vector<double> runs[2];
  std::size_t dirty = 0;
  for (std::vector<double>& log : runs) {
    scenario(log, dirty);
  }
  ASSERT_EQ(runs[0].size(), runs[1].size());
  EXPECT_EQ(0, std::memcmp(runs[0].data(), runs[1].data(), runs[0].size() * sizeof(double)));
  EXPECT_EQ(0u, dirty);
}

// A push, lost commands, a new load, the user stop and its release, a restart.
TEST(Repeatability, TorqueControlAndRequestsAreRepeatableAndRealTimeSafe) {
  expectRepeatableAndRealTimeSafe([](std::vector<double>& log, std::size_t& dirty) {
    const ControlUnitParameters parameters = pandaWithHand();
    ControlUnit unit(parameters);
    FakeArm arm(parameters.model, kReady);
    arm.payload = parameters.end_effector;
    franka_core::Payload load;
    load.mass = 0.1;
    load.com = {{0, 0, 0.1}};
    for (int i = 0; i < 4000; i++) {
      rt_guard::Scope scope;
      if (i == 500) {
        unit.request(torqueControl());
      } else if (i == 1000) {
        arm.push = {{5, -10, 20, 1, 0, -1}};
      } else if (i == 1500) {
        unit.request(loadRequest(load));
        unit.request(codec::SetEEToKRequest{parameters.F_T_NE});
        unit.request(codec::SetNEToEERequest{parameters.NE_T_EE});
        unit.request(collisionRequest(parameters.acceleration, parameters.nominal));
      } else if (i == 2000) {
        unit.request(codec::StopMoveRequest{});
      } else if (i == 3000) {
        unit.request(UserStop{true});
      } else if (i == 3300) {
        unit.request(UserStop{false});
        unit.request(codec::AutomaticErrorRecoveryRequest{});
      } else if (i == 3900) {
        unit.restart();
      }
      franka_core::RobotCommand command;
      command.tau_J_d[i % 7] = 0.3 * std::sin(0.01 * i);
      const franka_core::RobotState& state = tick(unit, arm, i % 11 == 0 ? nullptr : &command);
      dirty += scope.allocations() + scope.locks();
      append(log, state);
    }
  });
}

// Over the FCI: a Cartesian motion, a collision, its reflex, recovery, and joints again.
TEST(Repeatability, MotionReflexAndRecoveryAreRepeatableAndRealTimeSafe) {
  std::array<int, 7> modes{};
  expectRepeatableAndRealTimeSafe([&](std::vector<double>& log, std::size_t& dirty) {
    ControlUnitParameters parameters = pandaWithHand();
    parameters.rules = InterfaceRules::kFci;
    parameters.protocol_version = 5;
    ControlUnit unit(parameters);
    FakeArm arm(parameters.model, kReady);
    arm.payload = parameters.end_effector;
    franka_core::fci::MoveRequest move;
    franka_core::RobotCommand command;
    for (int i = 0; i < 4000; i++) {
      rt_guard::Scope scope;
      if (i == 10) {
        move.motion_generator_mode = franka_core::MotionGeneratorMode::kCartesianVelocity;
        move.controller_mode = franka_core::ControllerMode::kCartesianImpedance;
        unit.request(move);
      } else if (i == 1000) {
        arm.push = {{0, -80, 0, 0, 0, 0}};
      } else if (i == 1200) {
        arm.push.fill(0.0);
      } else if (i == 1500) {
        unit.request(codec::AutomaticErrorRecoveryRequest{});
      } else if (i == 2500) {
        move.motion_generator_mode = franka_core::MotionGeneratorMode::kJointVelocity;
        move.controller_mode = franka_core::ControllerMode::kJointImpedance;
        unit.request(move);
      }
      command.O_dP_EE_c[1] = i < 1000 ? 2e-5 * (i - 10) : 0.0;
      command.dq_c[0] = i > 2500 ? 1e-4 * (i - 2500) : 0.0;
      const franka_core::RobotState& state = tick(unit, arm, i % 11 == 0 ? nullptr : &command);
      dirty += scope.allocations() + scope.locks();
      append(log, state);
      modes[static_cast<std::size_t>(state.robot_mode)]++;
    }
  });
  EXPECT_GT(modes[static_cast<std::size_t>(franka_core::RobotMode::kMove)], 2 * 2000);
  EXPECT_GT(modes[static_cast<std::size_t>(franka_core::RobotMode::kReflex)], 2 * 200);
  EXPECT_GT(modes[static_cast<std::size_t>(franka_core::RobotMode::kAutomaticErrorRecovery)], 2);
}

TEST(Repeatability, GripperIsRepeatableAndRealTimeSafe) {
  expectRepeatableAndRealTimeSafe([](std::vector<double>& log, std::size_t& dirty) {
    GripperUnit gripper{GripperParameters{}};
    FakeHand hand;
    for (int i = 0; i < 3000; i++) {
      rt_guard::Scope scope;
      if (i == 10) {
        gripper.move(0.08, 0.1);
      } else if (i == 1000) {
        gripper.grasp(0.02, 0.005, 0.005, 0.05, 10);
      } else if (i == 2800) {
        gripper.stop();
      }
      hand.applyForces(gripper.step(hand.measure(), 1e-3));
      dirty += scope.allocations() + scope.locks();
      hand.step();
      log.push_back(hand.width());
    }
  });
}

TEST(Repeatability, GuardCountsAllocationsAndLocks) {
  rt_guard::Scope scope;
  std::vector<double>* leak = new std::vector<double>(100);
  const std::size_t counted = scope.allocations();
  delete leak;
  EXPECT_TRUE(counted >= 2 || !rt_guard::kActive);
}

}  // namespace

}  // namespace franka_sim::test
