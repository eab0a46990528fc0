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

#include "arm_fixture.h"

namespace franka_sim::test {

namespace {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;
using franka_core::RobotState;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_F(ArmTest, EveryRequestInEveryModeFollowsTheTable) {
  using Request = std::function<std::optional<Status>(ControlUnit&)>;
  const Request start = [](ControlUnit& u) { return u.request(torqueControl()); };
  const Request stop = [](ControlUnit& u) { return u.request(codec::StopMoveRequest{}); };
  const Request recover = [](ControlUnit& u) {
    return u.request(codec::AutomaticErrorRecoveryRequest{});
  };
  const Request press = [](ControlUnit& u) { return u.request(UserStop{true}); };
  const Request release = [](ControlUnit& u) { return u.request(UserStop{false}); };
  constexpr auto kYes = Status::kSuccess;
  constexpr auto kNo = Status::kCommandNotPossibleRejected;
  constexpr auto kManual = Status::kManualErrorRecoveryRequiredRejected;
  constexpr auto kStarted = Status::kMotionStarted;
  constexpr auto kLater = std::nullopt;
  struct Cell {
    const char* what;
    RobotMode from;
    Request request;
    std::optional<Status> status;
    RobotMode to;
  };
  const Cell cells[] = {
      {"start in Idle", RobotMode::kIdle, start, kStarted, RobotMode::kMove},
      {"start in Move", RobotMode::kMove, start, kNo, RobotMode::kMove},
      {"start in UserStopped", RobotMode::kUserStopped, start, kNo, RobotMode::kUserStopped},
      {"stop in Idle", RobotMode::kIdle, stop, kNo, RobotMode::kIdle},
      {"stop in Move", RobotMode::kMove, stop, kLater, RobotMode::kIdle},
      {"stop in UserStopped", RobotMode::kUserStopped, stop, kNo, RobotMode::kUserStopped},
      {"press in Idle", RobotMode::kIdle, press, kYes, RobotMode::kUserStopped},
      {"press in Move", RobotMode::kMove, press, kYes, RobotMode::kUserStopped},
      {"press twice", RobotMode::kUserStopped, press, kYes, RobotMode::kUserStopped},
      {"release in Idle", RobotMode::kIdle, release, kYes, RobotMode::kIdle},
      {"release in Move", RobotMode::kMove, release, kYes, RobotMode::kMove},
      {"release in UserStopped", RobotMode::kUserStopped, release, kYes, RobotMode::kIdle},
      {"recover in Idle", RobotMode::kIdle, recover, kYes, RobotMode::kIdle},
      {"recover in Move", RobotMode::kMove, recover, kYes, RobotMode::kMove},
      {"recover in UserStopped", RobotMode::kUserStopped, recover, kManual,
       RobotMode::kUserStopped},
  };
  for (const Cell& cell : cells) {
    rebuild();
    tick(unit, arm);
    if (cell.from == RobotMode::kMove) {
      unit.request(torqueControl());
    } else if (cell.from == RobotMode::kUserStopped) {
      unit.request(UserStop{true});
    }
    ASSERT_EQ(cell.from, unit.state().robot_mode) << cell.what;
    EXPECT_EQ(cell.status, cell.request(unit)) << cell.what;
    EXPECT_EQ(cell.to, unit.state().robot_mode) << cell.what;
    EXPECT_EQ(cell.to, unit.observe(arm.measure()).robot_mode) << cell.what;
    const bool moving = cell.to == RobotMode::kMove;
    EXPECT_EQ(moving ? MotionGeneratorMode::kNone : MotionGeneratorMode::kIdle,
              unit.state().motion_generator_mode)
        << cell.what;
    EXPECT_EQ(moving ? ControllerMode::kExternalController : ControllerMode::kOther,
              unit.state().controller_mode)
        << cell.what;
    EXPECT_EQ(cell.to == RobotMode::kUserStopped, unit.status().brakes_closed) << cell.what;
  }
}

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

TEST_F(ArmTest, UserStopLocksTheArmAndReleaseHoldsIt) {
  startTorqueControl();
  const franka_core::RobotCommand push = torques({{20, 0, 0, 0, 0, 0, 0}});
  run(100, &push);
  const double speed = arm.dq()[0];
  ASSERT_GT(speed, 0.3);
  unit.request(UserStop{true});
  EXPECT_FALSE(unit.status().brakes_closed) << "the motors stop it first";
  EXPECT_TRUE(unit.status().settling);
  // At 15 rad/s^2; then the arm catches up with its desired motion.
  run(static_cast<int>(speed / 15e-3) + 60, &push);
  EXPECT_TRUE(unit.status().brakes_closed);
  EXPECT_FALSE(unit.status().settling);
  EXPECT_EQ((std::array<double, 7>{}), arm.torques());
  const std::array<double, 7> stopped = arm.q();
  arm.push = {{0, 0, -50, 0, 0, 0}};
  run(1000, &push);
  EXPECT_EQ(stopped, arm.q());
  EXPECT_EQ((std::array<double, 7>{}), unit.state().tau_J_d);
  EXPECT_NEAR(50, unit.state().O_F_ext_hat_K[2], 0.25) << "the brakes' torque shows on the sensors";
  arm.push.fill(0.0);
  run(10);
  unit.request(UserStop{false});
  run(1000, &push);  // commands have no effect outside Move
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
  expectNear(stopped, arm.q(), 1e-5);
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
  const auto all = [](ControlUnit& u) {
    const ControlUnitParameters& p = u.configuration();
    return std::array<std::optional<Status>, 4>{
        u.request(codec::SetNEToEERequest{p.NE_T_EE}), u.request(codec::SetEEToKRequest{p.EE_T_K}),
        u.request(loadRequest(p.load)), u.request(collisionRequest(p.acceleration, p.nominal))};
  };
  for (const InterfaceRules rules : {InterfaceRules::kFci, InterfaceRules::kRosControl,
                                     InterfaceRules::kRosControlWithReflexes}) {
    const bool in_motion = rules != InterfaceRules::kFci;
    parameters.rules = rules;
    rebuild();
    tick(unit, arm);
    for (const std::optional<Status> status : all(unit)) {
      EXPECT_EQ(Status::kSuccess, status);
    }
    unit.request(torqueControl());
    for (const std::optional<Status> status : all(unit)) {
      EXPECT_EQ(in_motion ? Status::kSuccess : Status::kCommandNotPossibleRejected, status);
    }
    unit.request(UserStop{true});
    for (const std::optional<Status> status : all(unit)) {
      EXPECT_EQ(Status::kSuccess, status);
    }
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
      {-0.1, {{0, 0, 0}}, ball(0), "The mass is -0.1 kg"},
      {10.01, {{0, 0, 0}}, ball(0), "The mass is 10.01 kg; it must lie between 0 and 10 kg"},
      {1e300, {{0, 0, 0}}, ball(0), "The mass is 1e+300 kg"},
      {1, {{0, 0, 1.01}}, ball(0), "is 1.01 m from the flange; it must be within 1 m"},
      {1, {{0.8, 0.8, 0}}, ball(0), " m from the flange"},
      {1, {{100, 0, 0}}, ball(0), "is 100 m from the flange"},  // entered in millimeters
      {1, {{0, 0, 0}}, ball(10.01), "an entry of 10.01 kg m^2; none may be beyond 10 kg m^2"},
      {1, {{0, 0, 0}}, ball(1e12), "an entry of 1e+12 kg m^2"},
      {1, {{0, 0, 0}}, {{1, 0.5, 0, -0.5, 1, 0, 0, 0, 1}}, "symmetric"},
      {1, {{0, 0, 0}}, {{-1, 0, 0, 0, 1, 0, 0, 0, 1}}, "negative principal moments"},
      {1, {{0, 0, 0}}, {{1, 2, 0, 2, 1, 0, 0, 0, 1}}, "negative principal moments"},
      {INFINITY, {{0, 0, 0}}, ball(0), "finite numbers"},
      {kNan, {{0, 0, 0}}, ball(0), "finite numbers"},
      {1, {{0, kNan, 0}}, ball(0), "finite numbers"},
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

TEST_F(ArmTest, FramesFarFromTheArmAreRefused) {
  std::array<double, 16> frame = franka_core::kIdentityTransform;
  frame[12] = 10.0;
  EXPECT_EQ(Status::kSuccess, unit.request(codec::SetNEToEERequest{frame}));
  EXPECT_EQ(Status::kSuccess, unit.request(codec::SetEEToKRequest{frame}));
  for (const double far : {10.1, -1e3, 1e11, 1e308}) {
    frame[12] = far;
    EXPECT_EQ(Status::kInvalidArgumentRejected, unit.request(codec::SetNEToEERequest{frame}))
        << far;
    EXPECT_EQ(Status::kInvalidArgumentRejected, unit.request(codec::SetEEToKRequest{frame})) << far;
  }
  EXPECT_EQ(10.0, unit.state().NE_T_EE[12]) << "a refused frame changes nothing";
  EXPECT_EQ(10.0, unit.state().EE_T_K[12]);
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
