// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One tick of World against the bare mj_step calls of the same model, side by side in one run.
#include <benchmark/benchmark.h>
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/robot/control_unit.h>
#include <mujoco/mujoco.h>
#include <source_file.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace {

using franka_sim::ArmMeasurement;
using franka_sim::ArmPlant;
using franka_sim::RobotDescription;
using franka_sim::World;

constexpr std::array<double, 7> kHome{0, -0.785, 0, -2.356, 0, 1.571, 0.785};

RobotDescription panda(const franka_sim::RobotPhysics& physics = {}) {
  RobotDescription description;
  description.name = "panda";
  description.urdf = franka_test::readSource("franka_sim/robots/panda.urdf");
  description.base.position = {-0.5, 0, 0};
  setInitialPositions(kHome, "panda", description);
  applyPhysics(physics, "panda", description);
  return description;
}

std::unique_ptr<World> makeWorld(bool stone) {
  auto world = std::make_unique<World>(franka_test::sourceFile(
      stone ? "franka_sim/worlds/stone.xml" : "franka_sim/worlds/empty.xml"));
  world->addRobot(panda());
  return world;
}

/// A spring to the home pose: the same cheap controller for both sides.
double spring(int joint, double q, double dq, double load) {
  return load - 200 * (q - kHome[joint]) - 30 * dq;
}

void tickOfWorld(benchmark::State& state) {
  const auto world = makeWorld(state.range(0) != 0);
  ArmPlant& arm = world->arm("panda", "panda");
  for (auto _ : state) {
    const ArmMeasurement m = arm.measure();
    std::array<double, 7> tau;
    for (int i = 0; i < 7; ++i) {
      tau[i] = spring(i, m.q[i], m.dq[i], m.tau_J[i]);
    }
    arm.applyTorques(tau);
    world->step();
  }
}

void bareSteps(benchmark::State& state) {
  const std::string text = makeWorld(state.range(0) != 0)->mjcf(false);
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "merged.xml", static_cast<int>(text.size()));
  std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[0]));
  char error[500] = "";
  mjModel* model = mj_loadXML("merged.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    state.SkipWithError(error);
    return;
  }
  mjData* data = mj_makeData(model);
  std::array<int, 7> dof, qpos;
  for (int i = 0; i < 7; ++i) {
    const std::string name = "panda_joint" + std::to_string(i + 1);
    const int joint = mj_name2id(model, mjOBJ_JOINT, name.c_str());
    dof[i] = model->jnt_dofadr[joint];
    qpos[i] = model->jnt_qposadr[joint];
    data->qpos[qpos[i]] = kHome[i];
  }
  mj_forward(model, data);
  for (auto _ : state) {
    for (int i = 0; i < 7; ++i) {
      data->qfrc_applied[dof[i]] =
          spring(i, data->qpos[qpos[i]], data->qvel[dof[i]], data->qfrc_bias[dof[i]]);
    }
    for (int substep = 0; substep < World::kSmallSteps; ++substep) {
      mj_step(model, data);
    }
  }
  mj_deleteData(data);
  mj_deleteModel(model);
}

/// A tick of control unit and world under torque control, with a profile of realism.
void tickOfRobot(benchmark::State& state, const char* realism) {
  const franka_sim::RobotPhysics physics = franka_sim::readRobotPhysics(
      franka_test::sourceFile("franka_description/config/physics.yaml"), "panda",
      franka_sim::readRealism(realism, "ideal"));
  World world;
  world.addRobot(panda(physics));
  ArmPlant& arm = world.arm("panda", "panda");
  const std::string urdf = franka_test::readSource("franka_sim/robots/panda.urdf");
  franka_sim::ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdf, "panda")};
  parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, "panda");
  applyPhysics(physics, parameters);
  franka_sim::ControlUnit unit(parameters);
  unit.observe(arm.measure());
  unit.request(franka_sim::torqueControl());
  franka_core::RobotCommand command;
  for (auto _ : state) {
    const franka_core::RobotState& now = unit.observe(arm.measure());
    for (int i = 0; i < 7; ++i) {
      command.tau_J_d[i] = spring(i, now.q[i], now.dq[i], 0.0);
    }
    arm.applyTorques(unit.actuate(&command));
    world.step();
  }
}

void hashOfState(benchmark::State& state) {
  const auto world = makeWorld(true);
  for (auto _ : state) {
    benchmark::DoNotOptimize(world->stateHash());
  }
}

// Argument 0: arm and hand alone, 1: with table, trays and stone.
BENCHMARK(bareSteps)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
BENCHMARK(tickOfWorld)->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tickOfRobot, ideal, "ideal")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tickOfRobot, real, "real")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tickOfRobot, recorded, "recorded")->Unit(benchmark::kMicrosecond);
BENCHMARK(hashOfState)->Unit(benchmark::kNanosecond);

}  // namespace

BENCHMARK_MAIN();
