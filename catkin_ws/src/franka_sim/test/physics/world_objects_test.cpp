// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Objects that are added and removed, states that are set, snapshots that continue to the last bit.
#include <gmock/gmock.h>

#include <cmath>

#include "test_support.h"

namespace franka_sim::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr const char* kBall =
    "<body name='marble' pos='0 0 0.5'><freejoint/><geom type='sphere' size='0.05' mass='0.3'/>"
    "</body>";
constexpr const char* kCube =
    "<sdf version='1.6'><model name='any'><link name='link'><inertial><mass>0.5</mass><inertia>"
    "<ixx>0.001</ixx><iyy>0.001</iyy><izz>0.001</izz></inertia></inertial><collision name='c'>"
    "<geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision></link></model></sdf>";

Pose at(double x, double y, double z) {
  Pose pose;
  pose.position = {x, y, z};
  return pose;
}

void run(World& world, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    world.step();
  }
}

TEST(WorldObjects, AddAndRemoveKeepOtherStates) {
  World world;
  world.addObject("ball", kBall, at(1, 0, 0.5));
  EXPECT_DOUBLE_EQ(world.bodyPose("ball").position[0], 1);
  EXPECT_DOUBLE_EQ(world.bodyPose("ball").position[2], 1.0);
  run(world, 200);
  const double fallen = 1.0 - 0.5 * 9.81 * 0.2 * 0.2;
  EXPECT_NEAR(world.bodyPose("marble").position[2], fallen, 1e-3);
  const Twist before = world.bodyTwist("ball");
  const Pose pose_before = world.bodyPose("ball");
  world.addObject("cube", kCube, at(0, 1, 2));
  world.addObject("other cube", kCube, at(0, -1, 2));
  EXPECT_THAT(world.objects(), ElementsAre("ball", "cube", "other cube"));
  EXPECT_EQ(world.bodyPose("ball").position, pose_before.position);
  EXPECT_NEAR(world.bodyTwist("ball").linear[2], before.linear[2], 1e-12);
  world.removeObject("ball");
  EXPECT_THROW(world.bodyPose("ball"), std::runtime_error);
  run(world, 3000);
  EXPECT_NEAR(world.bodyPose("cube").position[2], 0.05, 1e-3);
  EXPECT_NEAR(world.bodyPose("other cube::link").position[1], -1, 1e-3);
}

TEST(WorldObjects, AddingObjectsDoesNotMoveRobots) {
  World world;
  world.addRobot(robot("panda"));
  run(world, 10);
  const JointMeasurement before = world.joint("panda_joint2");
  const ArmPlant* arm = &world.arm("panda", "panda");
  world.addObject("cube", kCube, at(1, 1, 1));
  EXPECT_EQ(world.joint("panda_joint2").position, before.position);
  EXPECT_EQ(world.joint("panda_joint2").velocity, before.velocity);
  EXPECT_EQ(arm, &world.arm("panda", "panda"));
  expectSentence([&] { world.addObject("panda_link3", kCube, at(2, 2, 2)); },
                 {"panda_link3", "another name"});
  expectSentence([&] { world.addObject("panda", kCube, at(2, 2, 2)); }, {"panda", "robot"});
}

TEST(WorldObjects, ErrorsHaveACauseAndChangeNothing) {
  World world;
  world.addObject("ball", kBall, at(0, 0, 1));
  const auto refuses = [&](const char* name, const char* text,
                           std::initializer_list<const char*> parts) {
    expectSentence([&] { world.addObject(name, text, at(0, 0, 0)); }, parts);
  };
  refuses("", kCube, {"name"});
  refuses("ball", kCube, {"'ball'", "another name"});
  refuses("ball2", kBall, {"marble"});
  refuses("x", "", {"'x'", "well-formed"});
  refuses("x", "no xml", {"'x'", "well-formed"});
  refuses("x", "<robot name='r'/>", {"<robot>", "<sdf>", "<mujoco>"});
  refuses("x", "<mujoco/>", {"no body"});
  refuses("x", "<mujoco><option gravity='0 0 1'/></mujoco>", {"<option>", "whole world"});
  refuses("x", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>", {"<body>"});
  refuses("x", "<body mocap='true'/>", {"mocap"});
  refuses("x", "<body><geom type='cube' size='1'/></body>", {"'x'", "cube"});
  refuses("x", "<sdf version='1.6'><model name='m'/></sdf>", {"'x'", "link"});
  Pose bad = at(NAN, 0, 0);
  expectSentence([&] { world.addObject("x", kCube, bad); }, {"pose"});
  expectSentence([&] { world.removeObject("nobody"); }, {"nobody"});
  EXPECT_THAT(world.objects(), ElementsAre("ball"));
  EXPECT_THAT(world.bodies(), Not(Contains("x")));
}

TEST(WorldObjects, TwistsReferToTheBodysOrigin) {
  World world;
  world.setGravity({0, 0, 0});
  // The centre of mass is 0.2 m from the origin: rotation about it moves the origin.
  world.addObject("club",
                  "<body name='club'><freejoint/><inertial pos='0.2 0 0' mass='1' "
                  "diaginertia='0.01 0.01 0.01'/></body>",
                  at(0, 0, 1));
  Twist twist;
  twist.linear = {0.3, -0.2, 0.1};
  twist.angular = {0.5, 1.0, -2.0};
  Pose turned = at(1, 2, 3);
  turned.orientation = {std::cos(0.4), std::sin(0.4), 0, 0};
  world.setBodyPose("club", turned);
  world.setBodyTwist("club", twist);
  const Twist read = world.bodyTwist("club");
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(read.linear[i], twist.linear[i], 1e-12);
    EXPECT_NEAR(read.angular[i], twist.angular[i], 1e-12);
  }
  // Finite differences of the pose.
  world.step();
  const Pose moved = world.bodyPose("club");
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((moved.position[i] - turned.position[i]) / World::kTick, twist.linear[i], 2e-3);
  }
}

TEST(WorldObjects, GravitySettingSurvivesChanges) {
  World world;
  world.addObject("cube", kCube, at(0, 0, 5));
  world.setGravity({0, 0, -1.62});
  world.addObject("ball", kBall, at(1, 0, 5));
  run(world, 500);
  EXPECT_NEAR(world.bodyTwist("cube").linear[2], -1.62 * 0.5, 1e-9);
  world.reset();
  EXPECT_EQ(world.gravity()[2], -1.62);
  EXPECT_EQ(world.bodyPose("cube").position[2], 5);
  expectSentence([&] { world.setGravity({0, INFINITY, 0}); }, {"Gravity", "numbers"});
}

TEST(WorldObjects, SnapshotsContinueBitForBit) {
  World world;
  world.addRobot(robot("panda"));
  world.addObject("cube", kCube, at(0.5, 0, 0.8));
  ArmPlant& arm = world.arm("panda", "panda");
  const auto go = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const ArmMeasurement m = arm.measure();
      std::array<double, 7> tau{};
      for (int j = 0; j < 7; ++j) {
        tau[j] = 5 * std::sin(0.01 * static_cast<double>(world.ticks()) + j) - m.dq[j];
      }
      arm.applyTorques(tau);
      world.step();
    }
  };
  go(300);  // the cube bounces by now
  world.push("cube", {3, 1, 0}, {0, 0, 0.1}, 100);
  go(50);
  arm.setBrakes(true);
  go(5);
  const Snapshot snapshot = world.snapshot();
  const std::uint64_t ticks = world.ticks();
  go(20);
  arm.setBrakes(false);
  go(400);
  const std::uint64_t hash = world.stateHash();
  const Pose pose = world.bodyPose("cube");
  go(77);
  world.setGravity({0, 0, 3});
  for (int repetition = 0; repetition < 2; ++repetition) {
    world.restore(snapshot);
    EXPECT_EQ(world.ticks(), ticks);
    EXPECT_EQ(world.gravity()[2], -9.81);
    go(20);
    arm.setBrakes(false);
    go(400);
    EXPECT_EQ(world.stateHash(), hash);
    EXPECT_EQ(world.bodyPose("cube").position, pose.position);
  }
  world.addObject("ball", kBall, at(1, 1, 1));
  expectSentence([&] { world.restore(snapshot); }, {"snapshot", "came or went"});
  expectSentence([&] { world.restore(Snapshot()); }, {"snapshot"});
}

TEST(WorldObjects, ListsModelsAndJoints) {
  World world;
  EXPECT_THAT(world.objects(), IsEmpty());
  world.addRobot(robot("panda"));
  world.addObject("ball", kBall, at(1, 1, 1));
  EXPECT_THAT(world.bodies(), Contains("ball"));
  EXPECT_THAT(world.bodies(), Contains("panda_link7"));
  EXPECT_THAT(world.joints(), Contains("panda_joint7"));
  EXPECT_THAT(world.cameras(), IsEmpty());
}

}  // namespace
}  // namespace franka_sim::test
