// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One tick of a ControlUnit without physics, beside the model evaluation it contains.
#include <benchmark/benchmark.h>
#include <franka_sim_mujoco/robot/control_unit.h>

#include "panda_arm.h"

namespace {

using franka_sim_mujoco::ArmMeasurement;
using franka_sim_mujoco::ControlUnit;
using franka_sim_mujoco::ControlUnitParameters;

ControlUnitParameters parameters() {
  ControlUnitParameters parameters{franka_sim_mujoco::test::pandaModel()};
  parameters.end_effector = franka_sim_mujoco::test::pandaHand();
  parameters.F_T_NE = franka_sim_mujoco::test::handFrame();
  return parameters;
}

ArmMeasurement measurement(int i) {
  ArmMeasurement m;
  m.q = franka_sim_mujoco::test::kReady;
  m.q[1] += 1e-4 * (i % 100);
  m.dq.fill(0.1);
  m.tau_J.fill(1.0);
  return m;
}

void tick(benchmark::State& state, bool motion) {
  ControlUnit unit(parameters());
  unit.observe(measurement(0));
  if (motion) {
    unit.startTorqueControl();
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
BENCHMARK(modelAlone);

}  // namespace

BENCHMARK_MAIN();
