// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Objects that rest are held in place until something can move them (decision 60).
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/world/world_impl.h"
#include "stone_in_hand.h"

namespace franka_sim::test {
namespace {

class ObjectRestTest : public StoneInHandTest {
 protected:
  static constexpr double kWeight = 0.1024 * 9.81;  // of the stone [N]

  /// Ticks until objects are held, at most so many.
  bool settles(int ticks = 2000) {
    for (int k = 0; k < ticks && !held(); ++k) {
      tick(0.0, kHome);
    }
    return held();
  }

  bool held() { return implOf(world_).object_rest.held(); }

  double forceUp(const std::string& body) { return forceOn(body).z(); }

  double speedOf(const std::string& body) {
    const Twist twist = bodyState(world_, body).twist;
    return Eigen::Vector3d(twist.linear.data()).norm();
  }

  double heightOf(const std::string& body) { return bodyPose(world_, body).position[2]; }

  void addBox(const std::string& name, const std::string& half, double z) {
    const std::string size = half + " " + half + " " + half;
    world_.addObject(name,
                     "<body name='" + name + "'><freejoint/><geom type='box' size='" + size +
                         "' mass='0.1'/></body>",
                     at(0.0, 0.0, z));
  }

  /// MuJoCo lets a box tremble on one of its own size; a smaller one rests.
  void addStack() {
    addBox("lower", "0.02", 0.4399);
    addBox("upper", "0.015", 0.4749);
  }
};

TEST_P(ObjectRestTest, AStoneThatRestsIsHeldAndShowsItsContacts) {
  ASSERT_TRUE(settles());
  EXPECT_GT(world_.ticks(), 100U) << "it first sinks onto its tray";
  const Pose before = bodyPose(world_, "stone");
  for (int k = 0; k < 1000; ++k) {
    auto q_d = kHome;
    q_d[0] += 0.3 * std::sin(0.003 * k);
    tick(0.0, q_d);
    ASSERT_TRUE(held()) << k;
    ASSERT_NEAR(kWeight, forceUp("stone"), 1e-6 * kWeight) << k;
  }
  EXPECT_EQ(before.position, bodyPose(world_, "stone").position);
  EXPECT_EQ(before.orientation, bodyPose(world_, "stone").orientation);
  EXPECT_EQ(0.0, speedOf("stone"));
  EXPECT_EQ(4U, contacts(world_).size());
  world_.prepareStep();
  EXPECT_EQ(4U, contacts(world_).size());
  EXPECT_NEAR(kWeight, forceUp("stone"), 1e-6 * kWeight);
}

TEST_P(ObjectRestTest, ArmsMoveAsBesideAStoneThatIsNotHeld) {
  const auto swing = [this] {
    for (int k = 0; k < 2000; ++k) {
      auto q_d = kHome;
      q_d[0] += 0.3 * std::sin(0.003 * k);
      tick(0.0, q_d);
    }
    return arm_->measure();
  };
  ASSERT_TRUE(settles());
  const Snapshot snapshot = world_.snapshot();
  const ArmMeasurement with = swing();
  EXPECT_TRUE(held());
  world_.restore(snapshot);
  implOf(world_).object_rest.use(false);
  const ArmMeasurement without = swing();
  EXPECT_FALSE(held());
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(without.q[i], with.q[i], 1e-9) << i;
    EXPECT_NEAR(without.tau_J[i], with.tau_J[i], 1e-6) << i;
  }
}

TEST_P(ObjectRestTest, APushMovesItInTheNextTick) {
  ASSERT_TRUE(settles());
  const Snapshot snapshot = world_.snapshot();
  for (const bool prepared : {false, true}) {
    world_.restore(snapshot);
    if (prepared) {
      world_.prepareStep();
    }
    pushBody(world_, "stone", {0, 0, 2.0}, {}, 5);
    EXPECT_NEAR(kWeight, forceUp("stone"), 1e-6 * kWeight) << "of the last step";
    tick(0.0, kHome);
    EXPECT_FALSE(held());
    EXPECT_GT(speedOf("stone"), 0.005);
  }
  world_.restore(snapshot);
  pushBody(world_, id() + "_hand", {0, 0, 2.0}, {}, 5);
  tick(0.0, kHome);
  EXPECT_TRUE(held()) << "a push against the arm";
}

TEST_P(ObjectRestTest, ChangesFromOutsideCountInTheNextTick) {
  ASSERT_TRUE(settles());
  const Snapshot snapshot = world_.snapshot();
  const auto expectFalls = [&](const char* what) {
    run(10);
    EXPECT_FALSE(held()) << what;
    EXPECT_GT(speedOf("stone"), 0.01) << what;
    world_.restore(snapshot);
    tick(0.0, kHome);
    EXPECT_TRUE(held()) << "without " << what;
  };
  Pose raised = bodyPose(world_, "stone");
  raised.position[2] += 0.05;
  setBodyPose(world_, "stone", raised);
  expectFalls("a stone that is lifted");
  setGravity(world_, {0, 0, 5.0});
  expectFalls("another gravity");
  setBodyTwist(world_, "stone", {{0, 0, 0.5}, {}});
  expectFalls("a stone that is thrown");
}

TEST_P(ObjectRestTest, AStackIsHeldAndFallsWithoutItsSupport) {
  addStack();
  ASSERT_TRUE(settles(4000));
  const double height = heightOf("upper");
  run(500);
  EXPECT_EQ(height, heightOf("upper"));
  EXPECT_NEAR(0.1 * 9.81, forceUp("upper"), 1e-4);
  world_.removeObject("lower");
  run(100);
  EXPECT_LT(heightOf("upper"), height - 0.02);
  EXPECT_TRUE(settles(4000)) << "and rests again";
}

TEST_P(ObjectRestTest, AStackOfWhichOneIsPushedMoves) {
  addStack();
  ASSERT_TRUE(settles(4000));
  const double x = bodyPose(world_, "upper").position[0];
  pushBody(world_, "lower", {2.5, 0, 0}, {}, 200);
  run(200);
  EXPECT_GT(bodyPose(world_, "upper").position[0], x + 0.01);
}

TEST_P(ObjectRestTest, WhatCreepsOnATiltedTrayIsNotHeld) {
  constexpr double kTilt = 0.0087;  // half a degree
  setGravity(world_, {9.81 * std::sin(kTilt), 0, -9.81 * std::cos(kTilt)});
  for (int k = 0; k < 3000; ++k) {
    tick(0.0, kHome);
    ASSERT_FALSE(held()) << k;
  }
  EXPECT_GT(speedOf("stone"), 5e-8);
}

TEST_P(ObjectRestTest, APendulumIsNotHeldWhereItTurnsBack) {
  world_.addObject("pendulum",
                   "<body name='pendulum'><joint name='swing' type='hinge' axis='0 1 0'/>"
                   "<geom type='capsule' fromto='0 0 0 0 0 -0.3' size='0.01'/></body>",
                   at(0.5, 0.6, 0.8));
  setJointPosition(world_, "swing", 0.001);
  double lowest = 0.0;
  for (int k = 0; k < 3000; ++k) {
    tick(0.0, kHome);
    ASSERT_FALSE(held()) << k;
    lowest = std::min(lowest, jointState(world_, "swing").position);
  }
  EXPECT_LT(lowest, -0.0005) << "it swings";
}

/// The hand comes down over the stone with open fingers, and closes.
TEST_P(ObjectRestTest, ItIsFreeBeforeTheFirstTouch) {
  const auto [x, y, z] = bodyPose(world_, id() + "_hand_tcp").position;
  world_.addObject("stand", "<body name='stand'><geom type='box' size='0.03 0.02 0.05'/></body>",
                   at(x, y + 0.12, z - 0.082));
  setBodyPose(world_, "stone", at(x, y + 0.12, z));
  ASSERT_TRUE(settles());
  const auto robot_touches = [this] { return !touches(world_, "stone").robots.empty(); };
  int free = 0;
  double q = 0.0;
  for (int k = 0; k < 2000 && !robot_touches(); ++k) {
    q += 0.001;  // 1 rad/s
    auto q_d = kHome;
    q_d[0] += q;
    free = held() ? 0 : free + 1;
    tick(0.0, q_d);
  }
  ASSERT_TRUE(robot_touches());
  EXPECT_GE(free, 1) << "ticks before the touch";
  EXPECT_LE(free, 60) << "held as long as possible";
}

INSTANTIATE_TEST_SUITE_P(Robots, ObjectRestTest, ::testing::Values("fr3"));

}  // namespace
}  // namespace franka_sim::test
