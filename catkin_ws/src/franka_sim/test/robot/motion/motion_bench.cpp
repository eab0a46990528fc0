// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One tick of a MotionGenerator, for each kind of command.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <vector>

#include "../panda_arm.h"
#include "robot/motion/motion_generator.h"

namespace {

using franka_core::MotionGeneratorMode;
using franka_core::RobotCommand;
using franka_sim::MotionGenerator;
using franka_sim::MotionStart;

constexpr int kPeriod = 4096;  // ticks of a slow swing that begins and ends at rest

std::vector<RobotCommand> swing(const franka_core::ArmModel& model) {
  std::vector<RobotCommand> commands(kPeriod);
  const auto start = model.pose(franka_core::ArmFrame::kEndEffector, franka_sim::test::kReady,
                                franka_sim::kHandF_T_NE);
  for (int i = 0; i < kPeriod; i++) {
    const double phase = 2.0 * 3.14159265358979 * i / kPeriod;
    const double rate = 2.0 * 3.14159265358979 / (kPeriod * 1e-3);
    RobotCommand& command = commands[static_cast<std::size_t>(i)];
    command.q_c = franka_sim::test::kReady;
    command.q_c[0] += 0.1 * (1.0 - std::cos(phase));
    command.dq_c[0] = 0.1 * rate * std::sin(phase);
    command.O_T_EE_c = start;
    command.O_T_EE_c[12] += 0.03 * (1.0 - std::cos(phase));
    command.O_dP_EE_c[0] = 0.03 * rate * std::sin(phase);
  }
  return commands;
}

void tick(benchmark::State& state, MotionGeneratorMode mode, bool asynchronous) {
  const franka_core::ArmModel model = franka_sim::test::pandaModel();
  const std::vector<RobotCommand> commands = swing(model);
  MotionGenerator generator;
  MotionStart start;
  start.mode = mode;
  start.q_d = franka_sim::test::kReady;
  start.F_T_EE = franka_sim::kHandF_T_NE;
  start.asynchronous = asynchronous;
  start.maximum_velocity.fill(1.0);
  generator.start(start, model);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto step = generator.step(&commands[i++ % kPeriod], model);
    if (step.errors) {
      state.SkipWithError("the motion was refused");
      break;
    }
    benchmark::DoNotOptimize(generator.desired());
  }
}

BENCHMARK_CAPTURE(tick, jointPositions, MotionGeneratorMode::kJointPosition, false);
BENCHMARK_CAPTURE(tick, jointVelocities, MotionGeneratorMode::kJointVelocity, false);
BENCHMARK_CAPTURE(tick, cartesianPoses, MotionGeneratorMode::kCartesianPosition, false);
BENCHMARK_CAPTURE(tick, cartesianVelocities, MotionGeneratorMode::kCartesianVelocity, false);
BENCHMARK_CAPTURE(tick, asynchronous, MotionGeneratorMode::kJointPosition, true);

}  // namespace

BENCHMARK_MAIN();
