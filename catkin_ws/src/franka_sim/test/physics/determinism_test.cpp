// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>
#include <rt_guard/rt_guard.h>

#include <cmath>
#include <vector>

#include "test_support.h"

namespace franka_sim::test {
namespace {

RobotDescription atTheTable() {
  RobotDescription description = robot("panda");
  description.base.position = {-0.5, 0, 0};
  description.friction["panda_joint1"].coulomb = 0.5;
  return description;
}

/// Drives arm and hand for a while with contacts, a push and the brakes, and logs every state.
std::vector<std::uint64_t> drive(World* world, int ticks) {
  ArmPlant& arm = world->arm("panda", "panda");
  HandPlant& hand = world->hand("panda", "panda");
  const ArmHolder holder(&arm);
  std::vector<std::uint64_t> hashes;
  for (int k = 0; k < ticks; ++k) {
    auto target = kHome;
    target[0] -= 0.3 * std::sin(0.002 * k);
    target[5] += 0.2 * std::sin(0.005 * k);
    if (k == 100) {
      pushBody(*world, "stone", {0.3, 0.5, 0}, {0.001, 0, 0}, 50);
    }
    arm.setBrakes(k > 700 && k < 800);
    arm.applyTorques(holder.torques(target));
    const double force = k % 400 < 200 ? 2.0 : -2.0;
    hand.applyForces({force, force});
    world->step();
    hashes.push_back(world->stateHash());
  }
  return hashes;
}

TEST(DeterminismTest, ResetStartsTheSameRunAgain) {
  World world(test::world("stone"));
  world.addRobot(atTheTable());
  const std::uint64_t start = world.stateHash();
  const auto first = drive(&world, 1500);
  pushBody(world, "stone", {1, 0, 0}, {}, 1000);
  world.arm("panda", "panda").setBrakes(true);
  world.step();
  world.reset();
  EXPECT_EQ(start, world.stateHash());
  EXPECT_EQ(0u, world.ticks());
  EXPECT_EQ(first, drive(&world, 1500));
}

TEST(DeterminismTest, HashDependsOnTheLastBitOfTheState) {
  World world(test::world("stone"));
  world.addRobot(atTheTable());
  const std::uint64_t before = world.stateHash();
  setJointPosition(world, "panda_joint1", std::nextafter(0.0, 1.0));
  EXPECT_NE(before, world.stateHash());
  setJointPosition(world, "panda_joint1", 0.0);
  EXPECT_EQ(before, world.stateHash());
}

TEST(DeterminismTest, ATickNeitherAllocatesNorLocks) {
  World world(test::world("stone"));
  world.addRobot(atTheTable());
  ArmPlant& arm = world.arm("panda", "panda");
  HandPlant& hand = world.hand("panda", "panda");
  const ArmHolder holder(&arm);
  pushBody(world, "stone", {0.1, 0.1, 0}, {}, 100);
  world.setPreparesBeside(true);
  const rt_guard::Scope scope;
  for (int k = 0; k < 1000; ++k) {
    world.prepareBeside();
    arm.applyTorques(holder.torques(kHome));
    arm.setBrakes(k > 500 && k < 600);
    hand.applyForces({1, 1});
    world.step();
    world.prepareStep();
    hand.measure();
    world.stateHash();
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

}  // namespace
}  // namespace franka_sim::test
