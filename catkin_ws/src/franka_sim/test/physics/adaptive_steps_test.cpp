// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Long physics steps while robots move freely, short ones before and during contact (decision 58).
#include <franka_sim/physics/world_joints.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/world/world_impl.h"
#include "stone_in_hand.h"

namespace franka_sim::test {
namespace {

constexpr int kSmall = World::kSmallSteps;

class AdaptiveStepsTest : public StoneInHandTest {
 protected:
  /// A block that does not move, beside the hand: joint 1 turns the hand into it.
  void addWall() {
    world_.addObject("wall", "<body name='wall'><geom type='box' size='0.1 0.02 0.3'/></body>",
                     beside(0.22));
  }

  Pose beside(double y) {
    Pose pose = bodyPose(world_, id() + "_hand");
    pose.position[1] += y;
    pose.orientation = {1, 0, 0, 0};
    return pose;
  }

  bool robotTouches(const std::string& body) { return !touches(world_, body).robots.empty(); }
};

TEST_P(AdaptiveStepsTest, AFreeArmHasOneStepBesideAStoneThatRests) {
  run(1000);
  EXPECT_EQ(1, world_.substeps());
  for (int k = 0; k < 1000; ++k) {
    auto q_d = kHome;
    q_d[0] += 0.3 * std::sin(0.003 * k);
    tick(0.0, q_d);
    ASSERT_EQ(1, world_.substeps()) << "in tick " << k;
  }
  EXPECT_EQ(1, arm_->measure().substeps);
}

TEST_P(AdaptiveStepsTest, SmallStepsAreAnOption) {
  world_.setSubsteps(Substeps::kSmall);
  run(100);
  EXPECT_EQ(kSmall, world_.substeps());
  EXPECT_EQ(kSmall, arm_->measure().substeps);
}

TEST_P(AdaptiveStepsTest, ChangesFromOutsideCountInTheNextTick) {
  addWall();
  run(1000);
  const Snapshot free = world_.snapshot();
  const auto expectSmall = [&](const char* what) {
    tick();
    EXPECT_EQ(kSmall, world_.substeps()) << what;
    world_.restore(free);
    tick();
    EXPECT_EQ(1, world_.substeps()) << "without " << what;
  };
  placeStone();
  expectSmall("a stone in the hand");
  setBodyTwist(world_, "stone", {{0, 0, 0.1}, {}});
  expectSmall("a stone that moves");
  setJointPosition(world_, id() + "_joint1", 0.3);
  expectSmall("the hand at the wall");
}

TEST_P(AdaptiveStepsTest, FrictionThatNeedsSmallStepsHasThem) {
  World world;
  RobotDescription description = robot(id());
  description.friction[id() + "_joint7"] = {0, 0, 0, 0, /*coulomb=*/40.0};
  world.addRobot(description);
  world.step();
  EXPECT_EQ(kSmall, world.substeps());
}

TEST_P(AdaptiveStepsTest, SmallStepsBeginBeforeTheFirstTouch) {
  addWall();
  run(300);
  ASSERT_EQ(1, world_.substeps());
  double q = 0.0;
  int small = 0;
  for (int k = 0; k < 2000 && !robotTouches("wall"); ++k) {
    q += 0.002;  // 2 rad/s
    auto q_d = kHome;
    q_d[0] = q;
    small = world_.substeps() == kSmall ? small + 1 : 0;
    tick(0.0, q_d);
  }
  EXPECT_TRUE(robotTouches("wall"));
  EXPECT_GE(small, 1) << "ticks of small steps that ended without a touch";
}

INSTANTIATE_TEST_SUITE_P(Robots, AdaptiveStepsTest, ::testing::Values("panda"));

// --- against small steps throughout --------------------------------------------------------------

struct Outcome {
  double slip;                 ///< of the stone in the hand [m]
  Eigen::Vector3d stone;       ///< where it lies at the end, from the hand that carried it [m]
  double grip, weight, press;  ///< normal force of a finger, force that carries, on the wall [N]
  int changes;                 ///< to small steps
};

class ScenarioTest : public AdaptiveStepsTest {
 protected:
  /// Free motion, a grasp carried about, free motion again, and a push against a wall.
  Outcome play(Substeps substeps) {
    world_.setSubsteps(substeps);
    implOf(world_).object_rest.use(substeps == Substeps::kAdaptive);
    addWall();
    Outcome outcome{};
    refinements_ = 0;
    const auto swing = [](int k, double share) {
      auto q_d = kHome;
      q_d[0] -= share * 0.2 * (1.0 - std::cos(0.002 * k));
      q_d[5] += share * 0.2 * std::sin(0.003 * k);
      return q_d;
    };
    for (int k = 0; k < 1000; ++k) {
      tick(0.0, swing(k, 1.0));
    }
    for (int k = 0; k < 500; ++k) {
      tick(0.0, kHome);
    }
    placeStone();
    run(1000, 2.5);
    const Eigen::Vector3d start = stoneInHand();
    for (int k = 0; k < 4000; ++k) {
      tick(2.5, swing(k, std::min(1.0, k / 1000.0)));
      outcome.slip = std::max(outcome.slip, (stoneInHand() - start).norm());
    }
    outcome.grip = 0.5 * gripOf();
    outcome.weight = forceOn("stone").z();
    outcome.stone = stoneInHand();
    for (int k = 0; k < 3000; ++k) {
      tick(-2.0, swing(4000, 1.0));
    }
    for (int k = 0; k < 4000; ++k) {
      auto q_d = kHome;
      q_d[0] = std::min(0.0003 * k, 0.6);
      tick(0.0, q_d);
    }
    outcome.press = forceOn("wall").norm();
    outcome.changes = refinements_;
    return outcome;
  }

  /// Sum of the forces that both fingers exert on the stone [N].
  double gripOf() {
    double sum = 0.0;
    for (const Contact& contact : contacts(world_)) {
      const bool stone = contact.body1 == "stone" || contact.body2 == "stone";
      sum += stone ? Eigen::Vector3d(contact.force.data()).norm() : 0.0;
    }
    return sum;
  }
};

TEST_P(ScenarioTest, HasTheOutcomeOfSmallSteps) {
  const Outcome adaptive = play(Substeps::kAdaptive);
  world_.removeObject("wall");
  world_.reset();
  const Outcome small = play(Substeps::kSmall);
  EXPECT_NEAR(small.slip, adaptive.slip, 0.02 * small.slip);
  EXPECT_NEAR(0.0, (adaptive.stone - small.stone).norm(), 0.02 * small.stone.norm());
  EXPECT_NEAR(small.grip, adaptive.grip, 0.02 * small.grip);
  EXPECT_NEAR(small.weight, adaptive.weight, 0.02 * small.weight);
  EXPECT_NEAR(small.press, adaptive.press, 0.02 * small.press);
  EXPECT_GT(small.press, 5.0) << "the hand presses on the wall";
  EXPECT_EQ(0, small.changes);
  EXPECT_GE(adaptive.changes, 1) << "the wall";
  EXPECT_LE(adaptive.changes, 10);
}

INSTANTIATE_TEST_SUITE_P(Robots, ScenarioTest, ::testing::Values("fr3"));

}  // namespace
}  // namespace franka_sim::test
