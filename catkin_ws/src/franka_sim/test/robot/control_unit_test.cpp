// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Holding, external torque control and the signals of a ControlUnit on a simulated arm.
#include <franka_sim/robot/control_unit.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "arm_fixture.h"

namespace franka_sim::test {

namespace {

using franka_core::ArmFrame;
using franka_core::RobotState;

TEST_F(ArmTest, IdleHoldsItsDesiredPoseWithTheConfiguredStiffness) {
  arm.push = {{40, -30, 20, 0, 0, 0}};
  run(5000);
  const RobotState& s = unit.state();
  EXPECT_GT(largestDifference(kReady, s.q), 1e-3);
  EXPECT_EQ(kReady, s.q_d);
  for (std::size_t i = 0; i < 7; i++) {
    const double spring = parameters.joint_stiffness[i] * (s.q_d[i] - s.q[i]);
    EXPECT_NEAR(s.tau_ext_hat_filtered[i], spring, 0.005 * std::abs(spring) + 1e-6)
        << "joint " << i + 1;
  }
  arm.push.fill(0.0);
  run(2000);
  EXPECT_LT(largestDifference(kReady, s.q), 1e-5);
}

TEST_F(ArmTest, ZeroTorqueAtRestDriftsLessThanATenthOfAMilliradianInTenSeconds) {
  for (const std::array<double, 3>& gravity :
       {std::array<double, 3>{{0, 0, -9.81}}, std::array<double, 3>{{4.905, 0, -8.4957}}}) {
    parameters.gravity = arm.gravity = gravity;
    rebuild();
    arm.put(kReady);
    startTorqueControl();
    const franka_core::RobotCommand zero;
    double force = 0.0;
    double moment = 0.0;
    for (int i = 0; i < 10000; i++) {
      const RobotState& state = tick(unit, arm, &zero);
      force = std::max(force, norm(state.O_F_ext_hat_K, 0, 3));
      moment = std::max(moment, norm(state.O_F_ext_hat_K, 3, 3));
    }
    EXPECT_LT(largestDifference(kReady, arm.q()), 1e-4);
    EXPECT_LT(force, 1e-3);
    EXPECT_LT(moment, 1e-4);
    EXPECT_EQ(gravity, unit.state().O_ddP_O);
  }
}

TEST_F(ArmTest, AppliedTorqueIsCommandPlusGravityOfTheConfiguredLoad) {
  startTorqueControl();
  const franka_core::RobotCommand command = torques({{200, -200, 3, -88, 13, -13, 0.7}});
  const std::array<double, 7> saturated{{87, -87, 3, -87, 12, -12, 0.7}};
  unit.observe(arm.measure());
  const std::array<double, 7> applied = unit.actuate(&command);
  const std::array<double, 7> gravity = parameters.model.gravity(arm.q(), parameters.end_effector);
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_NEAR(saturated[i] + gravity[i], applied[i], 1e-9);
  }
  EXPECT_EQ(saturated, unit.observe(arm.measure()).tau_J_d);
}

TEST_F(ArmTest, ReportsAppliedAndMeasuredTorque) {
  startTorqueControl();
  const std::array<double, 7> tau{{0.1, -0.2, 0.3, -0.4, 0.05, -0.06, 0.07}};
  const franka_core::RobotCommand command = torques(tau);
  run(3, &command);
  const RobotState before = tick(unit, arm, &command);
  const RobotState after = tick(unit, arm, &command);
  EXPECT_EQ(tau, after.tau_J_d);
  const std::array<double, 7> gravity = parameters.model.gravity(before.q, parameters.end_effector);
  for (std::size_t i = 0; i < 7; i++) {
    const double expected = tau[i] + gravity[i] - 0.1 * (after.dq[i] - before.dq[i]) / 1e-3;
    EXPECT_NEAR(expected, after.tau_J[i], 1e-9);
    EXPECT_NEAR(after.q[i] + after.tau_J[i] / 14250, after.theta[i], 1e-12);
    EXPECT_NEAR(after.dq[i] + after.dtau_J[i] / 14250, after.dtheta[i], 1e-12);
  }
}

TEST_F(ArmTest, DerivativeOfTheTorqueFollowsARampThroughTheFilter) {
  startTorqueControl();
  // Locked joints measure exactly the ramp.
  ArmMeasurement m;
  m.q = kReady;
  m.tau_J = unit.state().tau_J;
  unit.observe(m);
  for (int i = 0; i < 30; i++) {
    m.tau_J[3] += 0.05;
    unit.observe(m);
  }
  EXPECT_NEAR(50.0, unit.state().dtau_J[3], 1e-3);
  EXPECT_NEAR(0.0, unit.state().dtau_J[4], 1e-9);
}

TEST_F(ArmTest, MissingOrNonFiniteCommandsKeepTheLastTorque) {
  startTorqueControl();
  const std::array<double, 7> tau{{0.5, 0, 0, 0, 0, 0, 0}};
  const franka_core::RobotCommand good = torques(tau);
  run(100, &good);
  EXPECT_DOUBLE_EQ(1.0, tick(unit, arm, nullptr).control_command_success_rate);
  EXPECT_DOUBLE_EQ(0.99, tick(unit, arm, &good).control_command_success_rate);
  EXPECT_EQ(tau, unit.state().tau_J_d);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    franka_core::RobotCommand command = good;
    command.tau_J_d[6] = bad;
    tick(unit, arm, &command);
  }
  const RobotState& state = tick(unit, arm, &good);
  EXPECT_EQ(tau, state.tau_J_d);
  EXPECT_NEAR(0.97, state.control_command_success_rate, 1e-12);
}

TEST_F(ArmTest, FillsPosesElbowAndTimeFromTheModel) {
  const RobotState& state = run(3);
  EXPECT_EQ(parameters.model.pose(ArmFrame::kEndEffector, state.q, state.F_T_EE, state.EE_T_K),
            state.O_T_EE);
  EXPECT_EQ(parameters.model.pose(ArmFrame::kEndEffector, state.q_d, state.F_T_EE, state.EE_T_K),
            state.O_T_EE_d);
  EXPECT_EQ(state.O_T_EE_d, state.O_T_EE_c);
  EXPECT_EQ((std::array<double, 2>{{kReady[2], -1.0}}), state.elbow_d);
  EXPECT_EQ(state.elbow_d, state.elbow_c);
  EXPECT_DOUBLE_EQ(state.q[2], state.elbow[0]);
  EXPECT_EQ(3u, state.message_id);
  EXPECT_EQ((std::array<double, 3>{{0, 0, -9.81}}), state.O_ddP_O);
}

TEST_F(ArmTest, ElbowFlipsAtItsAngle) {
  ArmMeasurement m;
  m.q = kReady;
  m.q[3] = -0.467;
  EXPECT_EQ(1.0, unit.observe(m).elbow[1]);
  m.q[3] = -0.4671;
  EXPECT_EQ(-1.0, unit.observe(m).elbow[1]);
}

TEST_F(ArmTest, FirstStateHasNoExternalForceAndGravityAsTorque) {
  ArmMeasurement moving;
  moving.q = kReady;
  moving.dq = {{1, -1, 1, -1, 1, -1, 1}};
  EXPECT_EQ((std::array<double, 7>{}),
            ControlUnit(parameters).observe(moving).tau_ext_hat_filtered);
  arm.push = {{30, 0, 0, 0, 0, 0}};
  const RobotState& state = unit.observe(arm.measure());
  EXPECT_EQ((std::array<double, 7>{}), state.tau_ext_hat_filtered);
  EXPECT_EQ((std::array<double, 7>{}), state.dtau_J);
  const std::array<double, 7> gravity = parameters.model.gravity(kReady, parameters.end_effector);
  expectNear(gravity, state.tau_J, 1e-9);
}

}  // namespace

}  // namespace franka_sim::test
