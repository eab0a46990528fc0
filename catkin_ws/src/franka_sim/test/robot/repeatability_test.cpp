// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The same inputs give the same bits, and a tick neither allocates nor locks.
#include <rt_guard/rt_guard.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "arm_fixture.h"

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

// Over the FCI: a Cartesian motion, a collision, its reflex, recovery, and joints again. Generated
// sequences: control_unit_properties_test.cpp.
TEST(Repeatability, MotionReflexAndRecoveryAreRepeatableAndRealTimeSafe) {
  std::vector<double> runs[2];
  std::size_t dirty = 0;
  std::array<int, 7> modes{};
  for (std::vector<double>& log : runs) {
    const ControlUnitParameters parameters = pandaOverFci();
    ControlUnit unit(parameters);
    FakeArm arm(parameters.model, kReady);
    arm.payload = parameters.end_effector;
    franka_core::RobotCommand command;
    for (int i = 0; i < 4000; i++) {
      rt_guard::Scope scope;
      if (i == 10) {
        unit.request(moveRequest(franka_core::MotionGeneratorMode::kCartesianVelocity,
                                 franka_core::ControllerMode::kCartesianImpedance));
      } else if (i == 1000) {
        arm.push = {{0, -80, 0, 0, 0, 0}};
      } else if (i == 1200) {
        arm.push.fill(0.0);
      } else if (i == 1500) {
        unit.request(codec::AutomaticErrorRecoveryRequest{});
      } else if (i == 2500) {
        unit.request(moveRequest(franka_core::MotionGeneratorMode::kJointVelocity));
      }
      command.O_dP_EE_c[1] = i < 1000 ? 2e-5 * (i - 10) : 0.0;
      command.dq_c[0] = i > 2500 ? 1e-4 * (i - 2500) : 0.0;
      const franka_core::RobotState& state = tick(unit, arm, i % 11 == 0 ? nullptr : &command);
      dirty += scope.allocations() + scope.locks();
      append(log, state);
      modes[static_cast<std::size_t>(state.robot_mode)]++;
    }
  }
  ASSERT_EQ(runs[0].size(), runs[1].size());
  EXPECT_EQ(0, std::memcmp(runs[0].data(), runs[1].data(), runs[0].size() * sizeof(double)));
  EXPECT_EQ(0u, dirty);
  EXPECT_GT(modes[static_cast<std::size_t>(franka_core::RobotMode::kMove)], 2 * 2000);
  EXPECT_GT(modes[static_cast<std::size_t>(franka_core::RobotMode::kReflex)], 2 * 200);
  EXPECT_GT(modes[static_cast<std::size_t>(franka_core::RobotMode::kAutomaticErrorRecovery)], 2);
}

}  // namespace

}  // namespace franka_sim::test
