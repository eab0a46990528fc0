// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Random sequences of ticks and changes in two worlds that must stay equal to the last bit: one
/// only runs, the other one also prepares its steps, is read, is restored from snapshots, and goes
/// on while a new robot or object is compiled.

#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "physics/world/world_impl.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

using Random = std::mt19937;

/// An arm over the stone's table, whose joint 1 has dry friction, and what commands it.
class Cell {
 public:
  Cell() {
    RobotDescription description = robot("panda");
    description.base.position = {-0.5, 0, 0.3};
    description.initial_positions["panda_finger_joint1"] = 0.0165;
    description.friction["panda_joint1"].coulomb = 0.5;
    world.addRobot(description);
    arm = &world.arm("panda", "panda");
    hand = &world.hand("panda", "panda");
    holder.emplace(arm);
  }

  void command(double turn, double force) {
    auto q_d = kHome;
    q_d[0] += turn;
    holder->hold(q_d);
    hand->applyForces({force, force});
  }

  World world{test::world("stone")};
  ArmPlant* arm;
  HandPlant* hand;
  std::optional<ArmHolder> holder;
};

struct Change {
  const char* name;
  std::function<void(Cell&)> make;
  /// Set for what is compiled: the same change, to be compiled while the world goes on.
  std::function<WorldChange(Cell&)> begin{};
};

bool hasBall(Cell& cell) {
  const auto objects = cell.world.objects();
  return std::find(objects.begin(), objects.end(), "ball") != objects.end();
}

bool hasVisitor(Cell& cell) { return cell.world.robots().size() == 2; }

RobotDescription visitor() {
  RobotDescription description = robot("fr3", "visitor");
  description.base = at(0, 2, 0);
  return description;
}

constexpr const char* kBallInTheAir = "<body><freejoint/><geom size='0.05'/></body>";

const std::vector<Change>& changes() {
  static const std::vector<Change> all{
      {"time", [](Cell&) {}},
      {"stone in the hand",
       [](Cell& c) { setBodyPose(c.world, "stone", bodyPose(c.world, "panda_hand_tcp")); }},
      {"stone in the air", [](Cell& c) { setBodyPose(c.world, "stone", at(0.2, 0.1, 0.5)); }},
      {"thrown stone", [](Cell& c) { setBodyTwist(c.world, "stone", {{0.1, 0, 1}, {0, 0, 3}}); }},
      {"pushed stone", [](Cell& c) { pushBody(c.world, "stone", {0.3, 0, 0.5}, {}, 30); }},
      {"pushed hand", [](Cell& c) { pushBody(c.world, "panda_hand", {5, -5, 5}, {}, 40); }},
      {"joint position", [](Cell& c) { setJointPosition(c.world, "panda_joint2", -0.5); }},
      {"joint velocity", [](Cell& c) { setJointVelocity(c.world, "panda_joint2", 0.5); }},
      {"other gravity", [](Cell& c) { setGravity(c.world, {0, 0, -3}); }},
      {"gravity", [](Cell& c) { setGravity(c.world, {0, 0, -9.81}); }},
      {"closed brakes", [](Cell& c) { c.arm->setBrakes(true); }},
      {"open brakes", [](Cell& c) { c.arm->setBrakes(false); }},
      {"ball",
       [](Cell& c) {
         hasBall(c) ? c.world.removeObject("ball")
                    : c.world.addObject("ball", kBallInTheAir, at(0.3, -0.4, 1));
       },
       [](Cell& c) {
         return hasBall(c) ? c.world.beginRemoveObject("ball")
                           : c.world.beginAddObject("ball", kBallInTheAir, at(0.3, -0.4, 1));
       }},
      {"visitor",
       [](Cell& c) {
         hasVisitor(c) ? c.world.removeRobot("visitor") : c.world.addRobot(visitor());
       },
       [](Cell& c) {
         return hasVisitor(c) ? c.world.beginRemoveRobot("visitor")
                              : c.world.beginAddRobot(visitor());
       }},
      {"reset", [](Cell& c) { c.world.reset(); }},
  };
  return all;
}

/// Ticks and changes whose effects a snapshot must undo.
void goElsewhere(Cell& cell, Random& random) {
  for (int i = 0; i < 3; i++) {
    const Change& change = changes()[random() % changes().size()];
    if (!change.begin) {
      change.make(cell);
    }
    cell.command(0.5, -2.0);
    cell.world.step();
  }
}

void expectEqual(Cell& one, Cell& other) {
  ASSERT_EQ(one.world.stateHash(), other.world.stateHash());
  EXPECT_EQ(one.world.ticks(), other.world.ticks());
  EXPECT_EQ(one.arm->measure().tau_J, other.arm->measure().tau_J);
  EXPECT_EQ(bodyState(one.world, "stone").twist.linear,
            bodyState(other.world, "stone").twist.linear);
  const auto expected = contacts(one.world), found = contacts(other.world);
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); i++) {
    EXPECT_EQ(expected[i].position, found[i].position);
    EXPECT_EQ(expected[i].force, found[i].force);
  }
}

/// What must not change a world's future, before the command of a tick. @returns its name
const char* disturb(Cell& cell, Cell& equal, Random& random) {
  World& world = cell.world;
  switch (random() % 32) {
    case 0: {
      if (random() % 2 == 0) {
        world.prepareStep();
      }
      const Snapshot before = world.snapshot();
      goElsewhere(cell, random);
      world.restore(before);
      expectEqual(equal, cell);
      return "a snapshot";
    }
    case 1:
      goElsewhere(cell, random);
      world.restore(equal.world.snapshot());
      expectEqual(equal, cell);
      return "a snapshot of the other world";
    case 2:
      contacts(world);
      bodyPose(world, "panda_hand");
      jointState(world, "panda_joint1");
      describeOverlaps(world, "panda");
      return "readings";
    case 3:
      world.prepareBeside();
      return "preparation by another thread";
    default:
      if (random() % 2 == 0) {
        world.prepareStep();
        return "preparation";
      }
      return "nothing";
  }
}

/// Reached by the sequences of all seeds.
struct Coverage {
  int held{0}, released{0}, small_steps{0}, one_step{0}, grasped{0};
};

class WorldSequences : public ::testing::Test {
 protected:
  void tick(Random& random, double turn, double force) {
    const char* what = disturb(disturbed_, plain_, random);
    for (Cell* cell : {&plain_, &disturbed_}) {
      cell->command(turn, force);
      cell->world.step();
    }
    SCOPED_TRACE(what);
    expectEqual(plain_, disturbed_);
    // Decided for this tick; a prepared world has decided for the next one.
    const World::Impl &plain = implOf(plain_.world), &disturbed = implOf(disturbed_.world);
    EXPECT_EQ(plain.object_rest.held(), disturbed.object_rest.held());
    EXPECT_EQ(plain.clearance.isClear(), disturbed.clearance.isClear());
    EXPECT_EQ(plain_.world.substeps(), disturbed_.world.substeps());
  }

  void run(unsigned seed, Coverage& coverage) {
    Random random(seed);
    disturbed_.world.setPreparesBeside(true);
    double force = 0.0, turn = 0.0;
    for (Cell* cell : {&plain_, &disturbed_}) {
      cell->world.reset();
      setGravity(cell->world, {0, 0, -9.81});
    }
    for (int k = 0; k < 400; k++) {  // until the stone rests
      tick(random, turn, force);
      ASSERT_FALSE(HasFatalFailure());
    }
    coverage.held += implOf(plain_.world).object_rest.held() ? 1 : 0;
    for (int i = 0; i < 40; i++) {
      const Change& change = changes()[random() % changes().size()];
      SCOPED_TRACE(change.name + (" in step " + std::to_string(i)) + " of seed " +
                   std::to_string(seed));
      const bool held = implOf(plain_.world).object_rest.held();
      disturb(disturbed_, plain_, random);
      if (change.begin) {
        WorldChange late = change.begin(disturbed_);
        std::thread compiling([&late] { late.compile(); });
        for (int k = 0; k < 20; k++) {
          tick(random, turn, force);
        }
        compiling.join();
        disturbed_.world.apply(late);
      } else {
        change.make(disturbed_);
      }
      change.make(plain_);
      force = random() % 3 == 0 ? 2.5 * (static_cast<double>(random() % 3) - 1.0) : force;
      // Objects rest after some time.
      const int ticks = random() % 4 == 0 ? 400 : static_cast<int>(1 + random() % 40);
      for (int k = 0; k < ticks; k++) {
        turn += random() % 100 < 50 ? 0.0 : 2e-4 * (static_cast<double>(i % 7) - 3.0);
        tick(random, turn, force);
        ASSERT_FALSE(HasFatalFailure());
        (plain_.world.substeps() == 1 ? coverage.one_step : coverage.small_steps)++;
      }
      const bool holds = implOf(plain_.world).object_rest.held();
      coverage.held += !held && holds ? 1 : 0;
      coverage.released += held && !holds ? 1 : 0;
      coverage.grasped += touches(plain_.world, "stone").robots.empty() ? 0 : 1;
    }
  }

  Cell plain_, disturbed_;
};

TEST_F(WorldSequences, AreEqualBitForBitWithPreparationReadingsAndSnapshots) {
  Coverage coverage;
  for (unsigned seed = 1; seed <= 4; seed++) {
    run(seed, coverage);
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_GT(coverage.held, 1);
  EXPECT_GT(coverage.released, 1);
  EXPECT_GT(coverage.one_step, 300);
  EXPECT_GT(coverage.small_steps, 300);
  EXPECT_GT(coverage.grasped, 1);
}

}  // namespace
}  // namespace franka_sim::test
