// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Many simulations on several threads: equal to each alone, observed, and what goes wrong in one.
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_pushes.h>
#include <franka_sim/simulation/batch.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim::test {
namespace {

/// Light enough that a permitted force makes it diverge.
constexpr char kFeather[] =
    R"(<body name="feather"><freejoint/>
         <inertial pos="0 0 0" mass="1e-7" diaginertia="1e-7 1e-7 1e-7"/>
         <geom type="sphere" size="0.01"/></body>)";

std::unique_ptr<Simulation> simulationOf(const std::string& robot, int seed) {
  Simulation::Robot one;
  one.setup.robot = one.setup.arm_id = robot;
  one.setup.realism = "recorded,seed=" + std::to_string(seed);
  one.setup.base[0] = -0.5;
  return std::make_unique<Simulation>("stone.xml", std::vector<Simulation::Robot>{one});
}

/// Each world moves elsewhere; the stone is pushed off its place.
void begin(Simulation& simulation, int world) {
  SimulatedRobot& robot = simulation.robots().front();
  auto target = robot.state().q;
  target[0] += 0.05 * (world - 2);
  target[5] += 0.2;
  robot.jointLaw().setTarget(target, 0.3);
  pushBody(simulation.world(), "stone", {1.0 + world, 0.5, 0.0}, {}, 100);
}

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

struct Worlds {
  Worlds(const std::string& robot, int number) {
    for (int i = 0; i < number; i++) {
      owned.push_back(simulationOf(robot, i + 1));
      all.push_back(owned.back().get());
    }
  }
  std::vector<std::unique_ptr<Simulation>> owned;
  std::vector<Simulation*> all;
};

TEST(Batch, EachWorldEqualsASingleRunForAnyNumberOfThreads) {
  constexpr int kWorlds = 5;
  std::vector<std::uint64_t> alone;
  for (int i = 0; i < kWorlds; i++) {
    const auto simulation = simulationOf("fr3", i + 1);
    begin(*simulation, i);
    simulation->step(600);
    alone.push_back(simulation->world().stateHash() ^ simulation->robots().front().units().hash());
  }
  for (const int threads : {1, 2, 7}) {
    const Worlds worlds("fr3", kWorlds);
    SimulationBatch batch(worlds.all, threads, Observer::defaultNames(*worlds.all[0]));
    for (int i = 0; i < kWorlds; i++) {
      begin(*worlds.all[i], i);
    }
    for (int i = 0; i < 12; i++) {
      batch.step(50);
    }
    for (int i = 0; i < kWorlds; i++) {
      Simulation& world = *worlds.all[i];
      EXPECT_EQ(alone[i], world.world().stateHash() ^ world.robots().front().units().hash())
          << "world " << i << " on " << threads << " threads";
    }
  }
}

TEST(Batch, ObservationsAreRowsOfTheWorldsPresentValues) {
  const Worlds worlds("fr3", 3);
  const std::string robot = "fr3";
  SimulationBatch batch(
      worlds.all, 2,
      {"stone.twist", robot + ".O_T_EE", "time", robot + ".width", "stone.pose", robot + ".q"});
  ASSERT_EQ(6u + 16u + 1u + 1u + 7u + 7u, batch.rowSize());
  begin(*worlds.all[1], 4);
  batch.step(80);
  for (std::size_t i = 0; i < 3; i++) {
    const double* row = &batch.observations()[i * batch.rowSize()];
    World& world = worlds.all[i]->world();
    SimulatedRobot& arm = worlds.all[i]->robots().front();
    const Twist twist = bodyState(world, "stone").twist;
    const Pose pose = bodyPose(world, "stone");
    EXPECT_DOUBLE_EQ(twist.linear[0], row[0]);
    EXPECT_DOUBLE_EQ(twist.angular[2], row[5]);
    EXPECT_DOUBLE_EQ(arm.state().O_T_EE[14], row[6 + 14]);
    EXPECT_DOUBLE_EQ(0.08, row[22]);
    EXPECT_DOUBLE_EQ(arm.units().hand()->width(), row[23]);
    EXPECT_DOUBLE_EQ(pose.position[1], row[25]);
    EXPECT_DOUBLE_EQ(pose.orientation[0], row[27]);
    EXPECT_DOUBLE_EQ(arm.state().q[6], row[37]);
  }
  EXPECT_GT(batch.observations()[batch.rowSize()], batch.observations()[0] + 0.01)
      << "the second world's stone was pushed";
  worlds.all[0]->reset();
  batch.observe();
  EXPECT_EQ(0.0, batch.observations()[22]);
}

TEST(Batch, AnotherSimulationTakesTheRowOfOne) {
  const Worlds worlds("fr3", 2);
  const auto other = simulationOf("fr3", 9);
  begin(*other, 0);
  other->step(30);
  SimulationBatch batch(worlds.all, 2, {"stone.pose", "time"});
  batch.step(10);
  const std::size_t time = batch.rowSize() - 1;
  const double* row = &batch.observations()[batch.rowSize()];
  batch.replace(1, *other);
  EXPECT_DOUBLE_EQ(0.030, row[time]);
  EXPECT_EQ(bodyPose(other->world(), "stone").position[0], row[0]);
  batch.step(20);
  EXPECT_DOUBLE_EQ(0.050, row[time]);
  EXPECT_DOUBLE_EQ(0.030, batch.observations()[time]);
  EXPECT_EQ(10u, worlds.all[1]->world().ticks());
}

TEST(Batch, OnlyASimulationWithTheObservedValuesTakesARow) {
  const Worlds worlds("panda", 2);
  SimulationBatch batch(worlds.all, 1, {"panda.q", "time"});
  const auto other = simulationOf("panda", 3);
  const auto fr3 = simulationOf("fr3", 3);
  const auto replaced = [&](std::size_t number, Simulation& simulation) {
    return refusal([&] { batch.replace(number, simulation); });
  };
  EXPECT_EQ("There is no world 2; the batch has 2.", replaced(2, *other));
  EXPECT_EQ("This simulation is already world 0 of the batch.", replaced(1, *worlds.all[0]));
  EXPECT_NE(replaced(1, *fr3).find("There is no value 'panda.q'"), std::string::npos);
  batch.step(5);
  EXPECT_EQ(5u, worlds.all[1]->world().ticks());
}

TEST(Batch, DefaultValuesAreThoseOfTheRobotsAndOfMovingObjects) {
  const auto simulation = simulationOf("panda", 1);
  const std::vector<std::string> names = Observer::defaultNames(*simulation);
  EXPECT_EQ((std::vector<std::string>{"time", "panda.q", "panda.dq", "panda.O_T_EE",
                                      "panda.robot_mode", "panda.width", "stone.pose"}),
            names);
}

TEST(Batch, InvalidArgumentsAreRefused) {
  const Worlds worlds("panda", 1);
  const auto made = [&](const std::vector<Simulation*>& all, int threads,
                        const std::vector<std::string>& observe) {
    return refusal([&] { SimulationBatch(all, threads, observe); });
  };
  EXPECT_NE(made({}, 1, {}).find("at least one"), std::string::npos);
  EXPECT_NE(made(worlds.all, 0, {}).find("1 to 1024 threads, not on 0"), std::string::npos);
  for (const char* name : {"", ".", "panda", "panda.", "panda.color", "moon.pose", "stone.q",
                           "panda.pose.q", "time.pose"}) {
    const std::string text = made(worlds.all, 1, {name});
    EXPECT_NE(text.find("There is no value '" + std::string(name) + "'"), std::string::npos)
        << text;
  }
  EXPECT_NE(made(worlds.all, 1, {"time", "time"}).find("named twice"), std::string::npos);
}

TEST(Batch, AWorldThatDivergesStopsAloneAndIsNamed) {
  const Worlds worlds("panda", 3);
  for (Simulation* simulation : worlds.all) {
    simulation->world().addObject("feather", kFeather, {{5, 5, 5}});
  }
  SimulationBatch batch(worlds.all, 2, {"time"});
  pushBody(worlds.all[1]->world(), "feather", {1e4, 0, 0}, {}, 5);
  batch.step(1);
  EXPECT_NE("", refusal([&] { batch.step(1); }));
  ASSERT_TRUE(worlds.all[1]->world().stopped());
  const std::uint64_t before = worlds.all[0]->world().ticks();
  const std::string text = refusal([&] { batch.step(10); });
  EXPECT_EQ(0u, text.find("World 1: "));
  EXPECT_EQ(before + 10, worlds.all[0]->world().ticks());
  EXPECT_EQ(before + 10, worlds.all[2]->world().ticks());
  worlds.all[1]->reset();
  EXPECT_EQ("", refusal([&] { batch.step(1); }));
}

TEST(Batch, ForkedProcessRaises) {
  const Worlds worlds("panda", 2);
  SimulationBatch batch(worlds.all, 2, {"time"});
  batch.step(5);
  const pid_t child = fork();
  if (child == 0) {
    const std::string text = refusal([&] { batch.step(1); });
    _exit(text.find("before the process was forked") == std::string::npos ? 1 : 0);
  }
  int status = -1;
  ASSERT_EQ(child, waitpid(child, &status, 0));
  EXPECT_EQ(0, status);
  batch.step(5);
  EXPECT_EQ(10u, worlds.all[1]->world().ticks());
}

}  // namespace
}  // namespace franka_sim::test
