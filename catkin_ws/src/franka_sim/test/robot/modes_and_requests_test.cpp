// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Modes, their transitions, and the answers of a ControlUnit to valid and invalid requests.
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arm_fixture.h"

namespace franka_sim::test {

namespace {

using franka_core::RobotMode;
using franka_core::RobotState;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_F(ArmTest, NothingStartsBeforeTheFirstMeasurement) {
  EXPECT_EQ(Status::kCommandNotPossibleRejected, unit.request(torqueControl()));
  EXPECT_EQ((std::array<double, 7>{}), unit.actuate(nullptr));
}

TEST_F(ArmTest, MotionStartsWithoutTorqueFromTheMeasuredPose) {
  arm.push = {{0, 30, 0, 0, 0, 0}};
  run(2000);
  const std::array<double, 7> q = arm.q();
  startTorqueControl();
  const std::array<double, 7> q_d = unit.state().q_d;
  expectNear(q, q_d, 1e-6);
  arm.push.fill(0.0);
  const RobotState& state = run(300, nullptr);
  EXPECT_EQ((std::array<double, 7>{}), state.tau_J_d);
  EXPECT_EQ(q_d, state.q_d) << "external torque control does not change q_d";
  EXPECT_EQ((std::array<double, 7>{}), state.dq_d);
  EXPECT_EQ((std::array<double, 7>{}), state.ddq_d);
}

TEST_F(ArmTest, SuccessRateBelongsToAMotion) {
  EXPECT_EQ(0.0, run(5).control_command_success_rate);
  startTorqueControl();
  const franka_core::RobotCommand zero;
  EXPECT_EQ(1.0, run(5, &zero).control_command_success_rate);
  unit.request(codec::StopMoveRequest{});
  EXPECT_EQ(0.0, run(5).control_command_success_rate);
  startTorqueControl();
  EXPECT_EQ(1.0, run(5, &zero).control_command_success_rate);
}

TEST_F(ArmTest, FinishedCommandEndsTheMotionInItsTick) {
  startTorqueControl();
  franka_core::RobotCommand command = torques({{5, 0, 0, 0, 0, 0, 0}});
  run(10, &command);
  command.torque_command_finished = true;
  tick(unit, arm, &command);
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
  EXPECT_EQ((std::array<double, 7>{}), tick(unit, arm, &command).tau_J_d);
}

TEST_F(ArmTest, StopReleasedEarlyIsCompleted) {
  for (const auto& [stop, release, mode] :
       {std::tuple{UnitRequest{UserStop{true}}, UnitRequest{UserStop{false}},
                   RobotMode::kUserStopped},
        std::tuple{UnitRequest{Brakes{true}}, UnitRequest{Brakes{false}}, RobotMode::kOther}}) {
    startTorqueControl();
    const franka_core::RobotCommand push = torques({{20, 0, 0, 0, 0, 0, 0}});
    run(100, &push);
    unit.request(stop);
    run(5, &push);
    unit.request(release);
    EXPECT_EQ(mode, unit.state().robot_mode);
    EXPECT_GT(unit.state().dq_d[0], 0.2) << "it goes on braking";
    int ticks = 0;
    while (unit.state().robot_mode == mode) {
      run(1, &push);
      ASSERT_LT(++ticks, 1000);
    }
    EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
    EXPECT_FALSE(unit.status().settling);
    EXPECT_FALSE(unit.status().brakes_closed);
    EXPECT_NEAR(0.0, arm.dq()[0], 0.01);
  }
}

TEST_F(ArmTest, BrakesCloseAtOnceAtRestAndNoLaterThanATenthOfASecondOtherwise) {
  unit.request(Brakes{true});
  EXPECT_TRUE(unit.status().brakes_closed);
  unit.request(Brakes{false});
  EXPECT_FALSE(unit.status().brakes_closed);
  // Pushed so hard that it never stands still.
  arm.push = {{0, 300, 0, 0, 0, 0}};
  run(20);
  unit.request(Brakes{true});
  int ticks = 0;
  while (!unit.status().brakes_closed) {
    run(1);
    ASSERT_LT(++ticks, 1000);
  }
  EXPECT_GE(ticks, 100);
}

TEST_F(ArmTest, SettersFollowTheRulesOfTheInterface) {
  const auto in_each_motion = [](ControlUnit& u) {
    const ControlUnitParameters& p = u.configuration();
    return std::vector<std::optional<Status>>{
        u.request(codec::SetNEToEERequest{p.NE_T_EE}),
        u.request(codec::SetEEToKRequest{p.EE_T_K}),
        u.request(loadRequest(p.load)),
        u.request(collisionRequest(p.acceleration, p.nominal)),
        u.request(codec::SetJointImpedanceRequest{p.joint_stiffness}),
        u.request(codec::SetCartesianImpedanceRequest{p.cartesian_stiffness}),
        u.request(codec::SetGuidingModeRequest{{}, true})};
  };
  const auto at_rest_only = [](ControlUnit& u) {
    return std::vector<std::optional<Status>>{
        u.request(codec::SetFiltersRequest{100, 100, 100, 100, 100}),
        u.request(SetVirtualWall{0, {{}, franka_core::kIdentityTransform, false}}),
        u.request(SetProtocolVersion{5})};
  };
  const auto expect = [&](Status first, Status second) {
    for (const std::optional<Status> status : in_each_motion(unit)) {
      EXPECT_EQ(first, status);
    }
    for (const std::optional<Status> status : at_rest_only(unit)) {
      EXPECT_EQ(second, status);
    }
  };
  constexpr auto kRefused = Status::kCommandNotPossibleRejected;
  for (const InterfaceRules rules : {InterfaceRules::kFci, InterfaceRules::kRosControl,
                                     InterfaceRules::kRosControlWithReflexes}) {
    const bool in_motion = rules != InterfaceRules::kFci;
    parameters.rules = rules;
    rebuild();
    tick(unit, arm);
    expect(Status::kSuccess, Status::kSuccess);
    unit.request(torqueControl());
    expect(in_motion ? Status::kSuccess : kRefused, kRefused);
    unit.request(UserStop{true});
    expect(Status::kSuccess, Status::kSuccess);
  }
}

TEST_F(ArmTest, FramesCombineAndMoveTheDesiredPose) {
  run(2);
  const std::array<double, 16> frame{{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1}};
  ASSERT_EQ(Status::kSuccess, unit.request(codec::SetNEToEERequest{frame}));
  const RobotState& state = run(2);
  EXPECT_EQ(frame, state.NE_T_EE);
  const double s = std::sqrt(0.5);
  const std::array<double, 16> expected{
      {s, s, 0, 0, -s, s, 0, 0, 0, 0, 1, 0, 0.3 * s, 0.1 * s, 0.4034, 1}};
  for (std::size_t i = 0; i < 16; i++) {
    EXPECT_NEAR(expected[i], state.F_T_EE[i], 1e-12) << i;
    EXPECT_NEAR(state.O_T_EE[i], state.O_T_EE_d[i], 1e-6) << i;
    EXPECT_EQ(state.O_T_EE_d[i], state.O_T_EE_c[i]) << i;
  }
}

TEST_F(ArmTest, LoadAndEndEffectorAreCombined) {
  franka_core::Payload load;
  load.mass = 0.24;
  load.com = {{0, 0, 0.2}};
  load.inertia = {{1e-3, 0, 0, 0, 2e-3, 0, 0, 0, 3e-3}};
  ASSERT_EQ(Status::kSuccess, unit.request(loadRequest(load)));
  const RobotState& state = unit.state();
  const franka_core::Payload& ee = parameters.end_effector;
  EXPECT_DOUBLE_EQ(ee.mass + 0.24, state.m_total);
  for (std::size_t i = 0; i < 3; i++) {
    EXPECT_NEAR((ee.mass * ee.com[i] + 0.24 * load.com[i]) / (ee.mass + 0.24), state.F_x_Ctotal[i],
                1e-12);
  }
  EXPECT_EQ(load.inertia, state.I_load);
  EXPECT_EQ(ee.inertia, state.I_ee);
  EXPECT_GT(state.I_total[0], state.I_load[0] + state.I_ee[0]);

  // An equal point mass 0.1 m below: both are 0.05 m from the common center.
  ASSERT_EQ(Status::kSuccess,
            unit.request(SetEndEffector{{0.24, {{0, 0, 0.1}}, {}}, parameters.F_T_NE}));
  EXPECT_DOUBLE_EQ(0.48, state.m_total);
  expectNear({{0, 0, 0.15}}, state.F_x_Ctotal, 1e-12);
  expectNear({{2.2e-3, 0, 0, 0, 3.2e-3, 0, 0, 0, 3e-3}}, state.I_total, 1e-12);
}

TEST_F(ArmTest, ExcessiveLoadsAreRefusedWithValueLimitAndUnit) {
  using Inertia = std::array<double, 9>;
  const auto ball = [](double moment) {
    return Inertia{{moment, 0, 0, 0, moment, 0, 0, 0, moment}};
  };
  struct Case {
    double mass;
    std::array<double, 3> com;
    Inertia inertia;
    const char* sentence;  // a part of it; empty: accepted
  };
  const Case cases[] = {
      {0.1024, {{0, 0, 0.1}}, ball(0), ""},
      {0, {{0, 0, 0}}, ball(0), ""},
      {10, {{0, 0, 1}}, ball(10), ""},
      {10.01, {{0, 0, 0}}, ball(0), "The mass is 10.01 kg; it must lie between 0 and 10 kg"},
      {1, {{0, 0, 1.01}}, ball(0), "is 1.01 m from the flange; it must be within 1 m"},
      {1, {{0, 0, 0}}, ball(10.01), "an entry of 10.01 kg m^2; none may be beyond 10 kg m^2"},
      {1, {{0, 0, 0}}, {{1, 0.5, 0, -0.5, 1, 0, 0, 0, 1}}, "symmetric"},
      {1, {{0, 0, 0}}, {{1, 2, 0, 2, 1, 0, 0, 0, 1}}, "negative principal moments"},
      {1, {{0, 0, 0}}, ball(kNan), "finite numbers"},
  };
  for (const Case& test : cases) {
    SCOPED_TRACE(test.mass);
    const franka_core::Payload load{test.mass, test.com, test.inertia};
    const bool good = *test.sentence == '\0';
    EXPECT_EQ(good ? Status::kSuccess : Status::kInvalidArgumentRejected,
              unit.request(loadRequest(load)));
    const std::string fault = payloadFault(load);
    EXPECT_EQ(good, fault.empty()) << fault;
    EXPECT_NE(std::string::npos, fault.find(test.sentence)) << fault;
  }
  EXPECT_EQ(10.0, unit.state().m_load) << "a refused load changes nothing";
}

TEST_F(ArmTest, GravityCompensationStaysWithinTheMotors) {
  ASSERT_EQ(Status::kSuccess, unit.request(loadRequest({10, {{1, 0, 0}}, {}})));
  const std::array<double, 7> limit{{87, 87, 87, 87, 12, 12, 12}};
  double largest = 0;
  for (int k = 0; k < 3; k++) {
    unit.observe(arm.measure());
    const std::array<double, 7> tau = unit.actuate(nullptr);
    for (std::size_t i = 0; i < 7; i++) {
      // The arm is at its desired pose: all torque is compensation.
      EXPECT_LE(std::abs(tau[i]), limit[i] + 1e-6) << i;
      largest = std::max(largest, std::abs(tau[i]) / limit[i]);
    }
  }
  EXPECT_NEAR(1.0, largest, 1e-6) << "the load exceeds what the motors can hold";
}

TEST_F(ArmTest, RestartClearsTheStateAndHoldsTheNewPose) {
  startTorqueControl();
  const franka_core::RobotCommand push = torques({{20, 0, 0, 0, 0, 0, 0}});
  run(200, &push);
  unit.request(codec::StopMoveRequest{});
  const std::array<double, 7> elsewhere{{0.5, 0, -0.5, -2, 0.3, 1.8, 0}};
  arm.put(elsewhere);
  unit.restart();
  const std::uint64_t id = unit.state().message_id;
  const RobotState first = tick(unit, arm);
  EXPECT_EQ(id + 1, first.message_id);
  EXPECT_EQ(elsewhere, first.q_d);
  EXPECT_EQ((std::array<double, 7>{}), first.tau_ext_hat_filtered);
  EXPECT_EQ((std::array<double, 7>{}), first.dtau_J);
  run(500);
  EXPECT_EQ((std::array<double, 7>{}), unit.state().joint_collision);
  expectNear(elsewhere, arm.q(), 1e-9);
}

TEST(ControlUnitParameters, InvalidOnesAreRefusedByName) {
  const std::pair<const char*, std::function<void(ControlUnitParameters&)>> rows[] = {
      {"parameter NE_T_EE is not a frame on the arm: column 1", [](auto& p) { p.NE_T_EE[0] = 2; }},
      {"F_T_NE", [](auto& p) { p.F_T_NE[15] = 0; }},
      {"EE_T_K", [](auto& p) { p.EE_T_K[12] = kNan; }},
      {"m_ee", [](auto& p) { p.end_effector.mass = -1; }},
      {"F_x_Cload", [](auto& p) { p.load.com[0] = kNan; }},
      {"gravity_vector", [](auto& p) { p.gravity[2] = kNan; }},
      {"rotor_inertia", [](auto& p) { p.rotor_inertia[3] = -0.1; }},
      {"max_torque", [](auto& p) { p.max_torque[0] = kNan; }},
      {"collision_config", [](auto& p) { p.nominal.lower_force[0] = -1; }}};
  for (const auto& [name, change] : rows) {
    ControlUnitParameters parameters = pandaWithHand();
    change(parameters);
    try {
      ControlUnit unit(parameters);
      ADD_FAILURE() << name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find(name)) << error.what();
    }
  }
}

}  // namespace

}  // namespace franka_sim::test
