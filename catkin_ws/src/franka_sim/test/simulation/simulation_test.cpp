// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Robots that a program drives in its own process: commands, laws, refusals, resets.
#include <franka_sim/physics/world_pushes.h>
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim/simulation/policy_episode.h>
#include <franka_sim/simulation/simulation.h>
#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "../physics/test_support.h"
#include "../robot/arm_fixture.h"
#include "../robot/fake_hand.h"
#include "fci/robot_server.h"
#include "serve/operator_switches.h"

namespace franka_sim::test {
namespace {

using franka_core::RobotCommand;
using franka_core::RobotMode;
using franka_core::fci::MoveRequest;
using Array7 = std::array<double, 7>;

MoveRequest positions() {
  MoveRequest motion;
  motion.motion_generator_mode = franka_core::MotionGeneratorMode::kJointPosition;
  return motion;
}

class SimulationTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<Simulation> simulationOf(const std::string& realism,
                                           const std::string& world = "") const {
    Simulation::Robot robot;
    robot.setup.robot = robot.setup.arm_id = GetParam();
    robot.setup.realism = realism;
    robot.setup.base[0] = -0.5;  // beside the stone's table
    return std::make_unique<Simulation>(world, std::vector<Simulation::Robot>{robot});
  }
  SimulatedRobot& arm(Simulation& simulation) const { return simulation.robot(GetParam()); }
};

/// A robot whose ports the system has chosen.
class OperatorSwitches : public ::testing::Test {
 protected:
  OperatorSwitches() { robot.observe(); }

  static fci::RobotServerParameters server() {
    fci::RobotServerParameters parameters =
        fci::makeServerParameters("127.0.0.1", {6, 10}, pandaModel());
    parameters.port = 0;
    return parameters;
  }

  FakeArm arm{pandaModel(), kReady};
  FakeHand fingers;
  fci::SimRobot robot{pandaOverFci(), arm, server(), fci::SimRobot::Hand{&fingers, {}, 0}};
};

TEST_F(OperatorSwitches, FciStaysOffWhileAnotherProgramHasItsPort) {
  for (const auto switch_to : {&setFci, &setPower}) {
    switch_to(robot, false);
    EXPECT_FALSE(robot.server().isOpen());
    {
      const fci::Listener other("127.0.0.1", robot.server().port());
      expectSentence([&] { switch_to(robot, true); },
                     {"FCI", std::to_string(robot.server().port()).c_str()});
      EXPECT_FALSE(robot.unit().status().fci_active);
    }
    setFci(robot, true);
    EXPECT_TRUE(robot.server().isOpen());
  }
}

TEST_F(OperatorSwitches, EndEffectorStaysOffWhileAnotherProgramHasItsPort) {
  const auto power = [this] { return robot.whole().safety().state().end_effector_power; };
  setEndEffectorPower(robot, false);
  {
    const fci::Listener other("127.0.0.1", robot.gripperPort());
    const std::string port = std::to_string(robot.gripperPort());
    expectSentence([&] { setEndEffectorPower(robot, true); }, {"end effector", port.c_str()});
    EXPECT_FALSE(power());
    setPower(robot, false);
    expectSentence([&] { setPower(robot, true); }, {"end effector", port.c_str()});
    EXPECT_TRUE(robot.server().isOpen());
    EXPECT_FALSE(power());
  }
  setEndEffectorPower(robot, true);
  EXPECT_TRUE(power());
}

TEST(HandPolicy, ClosesTheHandBelowZeroOnly) {
  FakeHand fingers;
  fingers.put(0.08);
  GripperParameters parameters;
  parameters.gains = {FingerGains{100, 0, 1}, FingerGains{100, 0, 1}};
  GripperUnit unit{parameters};
  HandPolicy policy(unit);
  for (const auto& [action, width] :
       {std::pair{0.0, 0.08}, std::pair{-0.01, 0.0}, std::pair{0.0, 0.08}}) {
    for (int i = 0; i < 2000; i++) {
      policy.apply(action);
      fingers.applyForces(unit.step(fingers.measure(), 1e-3));
      fingers.step();
    }
    EXPECT_NEAR(width, fingers.width(), 1e-3) << action;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, SimulationTest, ::testing::Values("panda", "fr3"),
                         [](const auto& param) { return std::string(param.param); });

TEST_P(SimulationTest, JointLawReachesItsTargetSmoothly) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  Array7 target = robot.state().q;
  for (double& q : target) {
    q += 0.2;
  }
  robot.jointLaw().setTarget(target, 1.0);
  double fastest = 0.0;
  for (int i = 0; i < 1500; i++) {
    simulation->step(1);
    ASSERT_EQ(RobotMode::kMove, robot.state().robot_mode) << i;
    fastest = std::max(fastest, robot.state().dq[0]);
  }
  EXPECT_LT(largestDifference(target, robot.state().q), 2e-3);
  EXPECT_NEAR(fastest, 0.2 * 1.875, 0.03) << "of a polynomial of fifth order";
}

TEST_P(SimulationTest, SharesUserStopAndSelfTestWithTheControlInterface) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  SafetyController& safety = robot.units().safety();
  const SafetyInput stop = safety.isFr3() ? SafetyInput::kX33 : SafetyInput::kX4;
  safety.press(stop, true);
  robot.request(UserStop{true}, "The user stop");
  robot.request(UserStop{false}, "The user stop");
  simulation->step(100);
  EXPECT_EQ(RobotMode::kUserStopped, robot.state().robot_mode);
  safety.press(stop, false);
  simulation->step(1);
  EXPECT_EQ(RobotMode::kIdle, robot.state().robot_mode);
  ASSERT_EQ(Refusal::kNone, safety.startSelfTest());
  EXPECT_THROW(robot.request(Brakes{false}, "The brakes"), RequestRefused);
  EXPECT_THROW(robot.request(Guiding{true}, "Guiding"), RequestRefused);
  simulation->step(1);
  EXPECT_EQ(RobotMode::kOther, robot.state().robot_mode);
}

TEST_P(SimulationTest, CartesianLawReachesItsTargetAndYieldsAsASpring) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  std::array<double, 16> target = robot.state().O_T_EE;
  target[12] += 0.05;
  target[14] -= 0.05;
  CartesianLaw& law = robot.cartesianLaw();
  law.setStiffness({1000, 1000, 1000, 100, 100, 100});
  law.setTarget(target, 1.0);
  simulation->step(3000);
  for (const int i : {12, 13, 14}) {
    EXPECT_NEAR(target[i], robot.state().O_T_EE[i], 1e-3);
  }
  const double before = robot.state().O_T_EE[13];
  pushBody(simulation->world(), robot.setup().arm_id + std::string("_hand"), {0, 5, 0}, {}, 4000);
  simulation->step(4000);
  EXPECT_NEAR(5.0 / 1000, robot.state().O_T_EE[13] - before, 1e-3);
}

TEST_P(SimulationTest, AResetEndsErrorsAndKeepsTheConfiguration) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  const franka_core::RobotState& state = robot.state();
  robot.request(franka_sim::loadRequest({0.5, {0, 0, 0.05}, {}}), "The load");
  RobotCommand command;
  command.q_c = {1, 1, 1, -1, 1, 1, 1};
  robot.command(positions(), command);
  simulation->step(100);
  EXPECT_EQ(RobotMode::kReflex, state.robot_mode);
  simulation->reset();
  EXPECT_EQ(RobotMode::kIdle, state.robot_mode);
  EXPECT_EQ(1u, state.message_id);
  EXPECT_EQ(0.5, state.m_load);
  for (const bool error : state.errors) {
    EXPECT_FALSE(error);
  }
}

TEST_P(SimulationTest, AMotionOfAnotherKindIsRefusedUntilTheFirstHasEnded) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  robot.jointLaw();
  simulation->step(5);
  EXPECT_THROW(robot.command(positions(), {}), RequestRefused);
  robot.finish();
  simulation->step(500);
  EXPECT_FALSE(robot.moving());
  EXPECT_EQ(Status::kSuccess, robot.lastResult());
  RobotCommand command;
  command.q_c = robot.state().q_d;
  robot.command(positions(), command);
  simulation->step(5);
  EXPECT_EQ(RobotMode::kMove, robot.state().robot_mode);
}

TEST_P(SimulationTest, AResetRepeatsTheRunBitForBit) {
  for (const char* realism : {"ideal", "recorded,seed=3"}) {
    const auto run = [this](Simulation& simulation, int ticks_at_once) {
      SimulatedRobot& robot = arm(simulation);
      Array7 target = robot.state().q;
      target[3] += 0.3;
      robot.jointLaw().setTarget(target, 0.5);
      for (int i = 0; i < 800; i += ticks_at_once) {
        simulation.step(ticks_at_once);
      }
      return std::pair(robot.units().hash(), simulation.world().stateHash());
    };
    const auto simulation = simulationOf(realism, "stone.xml");
    const auto first = run(*simulation, 800);
    simulation->reset();
    EXPECT_EQ(RobotMode::kIdle, arm(*simulation).state().robot_mode);
    EXPECT_FALSE(arm(*simulation).moving());
    EXPECT_EQ(first, run(*simulation, 800)) << realism;
    EXPECT_EQ(first, run(*simulationOf(realism, "stone.xml"), 1)) << realism;
  }
}

TEST_P(SimulationTest, AnArmIsPlacedWithinItsLimitsOnly) {
  const auto simulation = simulationOf("ideal");
  SimulatedRobot& robot = arm(*simulation);
  Array7 q{0.3, 0.2, -0.1, -1.5, 0.1, 1.7, 0.4};
  simulation->place(robot, q);
  EXPECT_EQ(q, robot.state().q);
  simulation->step(1000);
  EXPECT_LT(largestDifference(q, robot.state().q), 1e-6) << "it holds";
  const Array7 before = robot.state().q;
  q[3] = 1.0;
  EXPECT_THROW(simulation->place(robot, q), std::invalid_argument);
  q[3] = std::nan("");
  EXPECT_THROW(simulation->place(robot, q), std::invalid_argument);
  EXPECT_EQ(before, robot.state().q) << "nothing has moved";
}

TEST_P(SimulationTest, StepsNeitherAllocateNorLock) {
  const auto simulation = simulationOf("recorded");
  SimulatedRobot& robot = arm(*simulation);
  Array7 target = robot.state().q;
  target[1] += 0.1;
  robot.jointLaw().setTarget(target, 0.2);
  simulation->step(10);
  rt_guard::Scope scope;
  simulation->step(300);
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

TEST(Simulation, ErrorsNameTheWrongArgument) {
  expectSentence([] { Simulation("nowhere.xml", {}); }, {"nowhere.xml"});
  Simulation empty("", {});
  EXPECT_THROW(empty.robot("panda"), std::out_of_range);
}

}  // namespace
}  // namespace franka_sim::test
