// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <rt_guard/rt_guard.h>

#include <cmath>
#include <functional>
#include <vector>

#include "test_support.h"

namespace franka_sim::test {
namespace {

RobotDescription atTheTable() {
  RobotDescription description = robot("panda");
  description.base.position = {-0.5, 0, 0};
  return description;
}

/// How steps are prepared before the arm's command is known.
enum class Preparation { kNone, kSameThread, kBeside };

void prepare(World* world, Preparation preparation) {
  if (preparation == Preparation::kSameThread) {
    world->prepareStep();
  }
  world->prepareBeside();  // without effect unless the world has a thread for it
}

/// Drives arm and hand for a while with contacts, a push and the brakes, and logs every state.
std::vector<std::uint64_t> drive(World* world, int ticks,
                                 Preparation preparation = Preparation::kNone) {
  world->setPreparesBeside(preparation == Preparation::kBeside);
  ArmPlant& arm = world->arm("panda", "panda");
  HandPlant& hand = world->hand("panda", "panda");
  const ArmHolder holder(&arm);
  std::vector<std::uint64_t> hashes;
  for (int k = 0; k < ticks; ++k) {
    auto target = kHome;
    target[0] -= 0.3 * std::sin(0.002 * k);
    target[5] += 0.2 * std::sin(0.005 * k);
    prepare(world, preparation);
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

void expectSame(const std::vector<Contact>& one, const std::vector<Contact>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].position, other[i].position);
    EXPECT_EQ(one[i].force, other[i].force);
  }
}

TEST(DeterminismTest, ReadingDoesNotChangeLaterStates) {
  World one(test::world("stone")), other(test::world("stone"));
  for (World* world : {&one, &other}) {
    world->addRobot(robot("panda"));  // begins in the table
  }
  EXPECT_NE("", describeOverlaps(other, "panda"));
  std::size_t seen = 0;
  for (int k = 0; k < 120; ++k) {
    one.step();
    other.step();
    bodyPose(other, "panda_hand");
    jointState(other, "panda_joint1");
    describeOverlaps(other, "panda");
    seen += contacts(other).size();
    ASSERT_EQ(one.stateHash(), other.stateHash());
  }
  EXPECT_GT(seen, 0u);
  expectSame(contacts(one), contacts(other));
}

TEST(DeterminismTest, PreparedStepsAreEqualBitForBit) {
  const auto run = [](Preparation preparation) {
    World world(test::world("stone"));
    world.addRobot(atTheTable());
    return drive(&world, 1500, preparation);
  };
  const std::vector<std::uint64_t> unprepared = run(Preparation::kNone);
  EXPECT_EQ(unprepared, run(Preparation::kSameThread));
  EXPECT_EQ(unprepared, run(Preparation::kBeside));
}

TEST(DeterminismTest, APreparedStepIsNotVisible) {
  World one(test::world("stone")), other(test::world("stone"));
  one.addRobot(atTheTable());
  other.addRobot(atTheTable());
  pushBody(one, "stone", {0.3, 0.5, 0}, {0.01, 0, 0}, 50);
  pushBody(other, "stone", {0.3, 0.5, 0}, {0.01, 0, 0}, 50);
  std::size_t seen = 0;
  for (int k = 0; k < 200; ++k) {
    one.step();
    other.step();
    other.prepareStep();
    ASSERT_EQ(one.stateHash(), other.stateHash());
    EXPECT_EQ(bodyPose(one, "stone").position, bodyPose(other, "stone").position);
    EXPECT_EQ(bodyState(one, "stone").twist.linear, bodyState(other, "stone").twist.linear);
    seen += contacts(one).size();
    expectSame(contacts(one), contacts(other));
    const Snapshot prepared = other.snapshot();
    other.step();
    other.restore(prepared);
    expectSame(contacts(one), contacts(other));
  }
  EXPECT_GT(seen, 100u);
}

TEST(DeterminismTest, ChangesAfterPreparationTakeEffect) {
  const std::vector<std::function<void(World*)>> changes{
      [](World* world) { setBodyPose(*world, "stone", {{0.2, 0.1, 0.5}, {1, 0, 0, 0}}); },
      [](World* world) { setBodyTwist(*world, "stone", {{0.1, 0, 1}, {0, 0, 3}}); },
      [](World* world) { setJointPosition(*world, "panda_joint2", -0.5); },
      [](World* world) { setJointVelocity(*world, "panda_joint2", 0.5); },
      [](World* world) { setGravity(*world, {1, 2, -3}); },
      [](World* world) { pushBody(*world, "stone", {3, 0, 0}, {}, 5); },
      [](World* world) { world->arm("panda", "panda").setBrakes(true); },
      [](World* world) { world->hand("panda", "panda").applyForces({5, 5}); },
      [](World* world) { world->removeRobot("panda"); },
      [](World* world) {
        world->addObject("ball", "<body><freejoint/><geom size='0.05'/></body>", {{0, 0, 1}});
      },
      [](World* world) { world->reset(); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto run = [&](Preparation preparation) {
      World world(test::world("stone"));
      world.addRobot(atTheTable());
      world.setPreparesBeside(preparation == Preparation::kBeside);
      world.step();
      prepare(&world, preparation);
      changes[i](&world);
      world.step();
      world.step();
      return world.stateHash();
    };
    EXPECT_EQ(run(Preparation::kNone), run(Preparation::kSameThread)) << "change " << i;
    EXPECT_EQ(run(Preparation::kNone), run(Preparation::kBeside)) << "change " << i;
  }
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
