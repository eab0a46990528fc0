// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One tick of a ControlUnit without physics, compared with its model evaluation.
#include <benchmark/benchmark.h>
#include <franka_sim/robot/control_unit.h>

#include <cmath>

#include "panda_arm.h"

namespace {

using franka_sim::ArmMeasurement;
using franka_sim::ControlUnit;
using franka_sim::ControlUnitParameters;

ControlUnitParameters parameters() {
  ControlUnitParameters parameters{franka_sim::test::pandaModel()};
  parameters.end_effector = franka_sim::test::pandaHand();
  parameters.F_T_NE = franka_sim::kHandF_T_NE;
  return parameters;
}

ArmMeasurement measurement(int i) {
  ArmMeasurement m;
  m.q = franka_sim::test::kReady;
  m.q[1] += 1e-4 * (i % 100);
  m.dq.fill(0.1);
  m.tau_J.fill(1.0);
  return m;
}

void tick(benchmark::State& state, bool motion) {
  ControlUnit unit(parameters());
  unit.observe(measurement(0));
  if (motion) {
    unit.request(franka_sim::torqueControl());
  }
  const franka_core::RobotCommand command;
  int i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(unit.observe(measurement(i++)));
    benchmark::DoNotOptimize(unit.actuate(&command));
  }
}

void idleTick(benchmark::State& state) { tick(state, false); }
void torqueControlTick(benchmark::State& state) { tick(state, true); }

/// A complete tick with the rules of the FCI and all checks; the arm follows its commands.
void fciTick(benchmark::State& state, franka_core::MotionGeneratorMode generator,
             franka_core::ControllerMode controller) {
  ControlUnitParameters p = parameters();
  p.rules = franka_sim::InterfaceRules::kFci;
  p.protocol_version = 5;
  p.nominal.upper_torque.fill(1e9);
  p.nominal.upper_force.fill(1e9);
  p.acceleration = p.nominal;
  ControlUnit unit(p);
  ArmMeasurement m;
  m.q = franka_sim::test::kReady;
  unit.observe(m);
  franka_core::fci::MoveRequest move;
  move.motion_generator_mode = generator;
  move.controller_mode = controller;
  unit.request(move);
  franka_core::RobotCommand command;
  command.O_T_EE_c = unit.state().O_T_EE_c;
  command.q_c = unit.state().q_d;
  const double height = command.O_T_EE_c[14];
  int i = 0;
  for (auto _ : state) {
    const double t = 1e-3 * ++i;
    command.O_T_EE_c[14] = height + 0.01 * (1 - std::cos(t));
    m.tau_J = unit.state().tau_J;
    benchmark::DoNotOptimize(unit.observe(m));
    benchmark::DoNotOptimize(unit.actuate(&command));
    m.q = unit.state().q_d;
    m.dq = unit.state().dq_d;
  }
  if (unit.state().robot_mode != franka_core::RobotMode::kMove) {
    state.SkipWithError("the motion has ended before the benchmark");
  }
}

void cartesianImpedanceTick(benchmark::State& state) {
  fciTick(state, franka_core::MotionGeneratorMode::kCartesianPosition,
          franka_core::ControllerMode::kCartesianImpedance);
}
void jointImpedanceTick(benchmark::State& state) {
  fciTick(state, franka_core::MotionGeneratorMode::kJointPosition,
          franka_core::ControllerMode::kJointImpedance);
}

void modelAlone(benchmark::State& state) {
  const ControlUnitParameters p = parameters();
  franka_core::ArmDynamics dynamics;
  int i = 0;
  for (auto _ : state) {
    const ArmMeasurement m = measurement(i++);
    p.model.computeDynamics(franka_core::ArmFrame::kEndEffector, m.q, m.dq, p.F_T_NE, p.EE_T_K,
                            p.end_effector, p.gravity, dynamics);
    benchmark::DoNotOptimize(dynamics);
  }
}

BENCHMARK(idleTick);
BENCHMARK(torqueControlTick);
BENCHMARK(jointImpedanceTick);
BENCHMARK(cartesianImpedanceTick);
BENCHMARK(modelAlone);

}  // namespace

BENCHMARK_MAIN();
