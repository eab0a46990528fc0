// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>

#include <cmath>

#include "test_support.h"

namespace franka_sim::test {
namespace {

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(WorldTest, LinkPosesMatchArmModel) {
  World world;
  RobotDescription description = robot("panda");
  description.base.position = {0.3, -0.2, 0.1};
  description.base.orientation = {std::cos(0.5), 0, 0, std::sin(0.5)};
  world.addRobot(description);
  const auto model = franka_core::ArmModel::fromUrdf(description.urdf, "panda");
  const auto flange = model.pose(franka_core::ArmFrame::kFlange, kHome);
  const Pose link8 = bodyPose(world, "panda_link8");
  EXPECT_NEAR(0.3 + std::cos(1.0) * flange[12] - std::sin(1.0) * flange[13], link8.position[0],
              1e-12);
  EXPECT_NEAR(-0.2 + std::sin(1.0) * flange[12] + std::cos(1.0) * flange[13], link8.position[1],
              1e-12);
  EXPECT_NEAR(0.1 + flange[14], link8.position[2], 1e-12);
  const Pose tcp = bodyPose(world, "panda_hand_tcp");
  EXPECT_NEAR(0.1034, distance(tcp.position, link8.position), 1e-12);
}

TEST(WorldTest, AddingAndRemovingRobotsKeepsTheRestBitForBit) {
  World alone(test::world("stone")), changing(test::world("stone"));
  RobotDescription first = robot("panda");
  first.base.position = {-0.5, 0, 0};
  RobotDescription second = robot("fr3", "visitor");
  second.base.position = {0, 5, 0};
  alone.addRobot(first);
  changing.addRobot(first);
  ArmPlant& undisturbed = alone.arm("panda", "panda");
  ArmPlant& kept = changing.arm("panda", "panda");
  const ArmHolder a(&undisturbed), b(&kept);
  for (int k = 0; k < 600; ++k) {
    undisturbed.setBrakes(k > 150 && k < 250);
    kept.setBrakes(k > 150 && k < 250);
    if (k == 200) {
      const std::uint64_t hash = changing.stateHash();
      changing.addRobot(second);
      changing.removeRobot("visitor");
      EXPECT_EQ(hash, changing.stateHash()) << "brakes, warm starts and torques included";
      changing.addRobot(second);
      EXPECT_EQ(200u, changing.ticks());
    }
    if (k == 400) {
      changing.removeRobot("visitor");
    }
    auto target = kHome;
    target[0] += 0.3 * std::sin(0.01 * k);
    undisturbed.applyTorques(a.torques(target));
    kept.applyTorques(b.torques(target));
    alone.step();
    changing.step();
    const ArmMeasurement x = undisturbed.measure(), y = kept.measure();
    for (int i = 0; i < 7; ++i) {
      // While the second robot is there the solver stops at other last digits.
      ASSERT_NEAR(x.q[i], y.q[i], 1e-9) << "tick " << k;
      ASSERT_NEAR(x.tau_J[i], y.tau_J[i], 1e-5) << "tick " << k;
    }
    ASSERT_LT(distance(bodyPose(alone, "stone").position, bodyPose(changing, "stone").position),
              1e-9);
  }
  EXPECT_EQ(std::vector<std::string>{"panda"}, changing.robots());
}

TEST(WorldTest, RefusesDuplicateNames) {
  World world;
  world.addRobot(robot("panda"));
  const std::uint64_t hash = world.stateHash();
  expectSentence([&] { world.addRobot(robot("panda")); }, {"already", "'panda'"});
  RobotDescription twin = robot("panda");
  twin.name = "twin";
  expectSentence([&] { world.addRobot(twin); }, {"'twin'", "'panda_link0'", "arm_id"});
  expectSentence([&] { world.removeRobot("ghost"); }, {"no robot 'ghost'"});
  EXPECT_EQ(hash, world.stateHash()) << "nothing changes when it throws";
}

TEST(WorldTest, RefusesUnknownBodiesAndJoints) {
  World world(test::world("stone"));
  world.addRobot(robot("panda"));
  expectSentence([&] { bodyPose(world, "ston"); }, {"no body 'ston'"});
  expectSentence([&] { bodyPose(world, ""); }, {"no body ''"});
  expectSentence([&] { setBodyPose(world, "table", {}); }, {"'table'", "not free"});
  expectSentence([&] { setBodyPose(world, "stone", {{0, 0, NAN}, {1, 0, 0, 0}}); }, {"not finite"});
  expectSentence([&] { setBodyPose(world, "stone", {{}, {0, 0, 0, 0}}); },
                 {"not a unit quaternion"});
  expectSentence([&] { jointState(world, "panda_joint8"); }, {"no joint 'panda_joint8'"});
  expectSentence([&] { jointState(world, "stone"); }, {"'stone'", "more than one degree"});
  expectSentence([&] { setJointPosition(world, "panda_joint1", 9); }, {"panda_joint1", "stops"});
  expectSentence([&] { pushBody(world, "moon", {}, {}, 1); }, {"no body 'moon'"});
  expectSentence([&] { pushBody(world, "stone", {NAN, 0, 0}, {}, 1); }, {"not finite"});
}

TEST(WorldTest, JointsCanBeTeleported) {
  World world;
  world.addRobot(robot("panda"));
  ArmPlant& arm = world.arm("panda", "panda");
  arm.setBrakes(true);
  setJointPosition(world, "panda_joint4", -1.5);
  EXPECT_EQ(-1.5, jointState(world, "panda_joint4").position);
  run(world, 200);
  EXPECT_NEAR(-1.5, arm.measure().q[3], 1e-4) << "the brake holds the new position";
}

/// A push of 1 N for 1 s moves a stone in free fall sideways by F / (2 m) t^2.
TEST(WorldTest, PushesActForExactlyTheirTicks) {
  World world(test::world("stone"));
  setBodyPose(world, "stone", at(5, 5, 50));
  pushBody(world, "stone", {0.1024, 0, 0}, {}, 1000);
  run(world, 1000);
  EXPECT_NEAR(5.5, bodyPose(world, "stone").position[0], 1e-3);
  run(world, 1000);
  EXPECT_NEAR(6.5, bodyPose(world, "stone").position[0], 1e-3) << "then it flies on at 1 m/s";
}

TEST(WorldTest, PushAtAPointTurnsTheBody) {
  World world(test::world("stone"));
  setBodyPose(world, "stone", at(5, 5, 50));
  // 1e-3 N at 0.01 m from the center about z: 1e-5 Nm on 1.407e-5 kg m^2 for 0.1 s.
  pushBody(world, "stone", {0, 1e-3, 0}, {}, 100, {{5.01, 5, 50}});
  run(world, 100);
  const auto turn = bodyPose(world, "stone").orientation;
  EXPECT_NEAR(0.5 * 1e-5 / 1.407e-5 * 0.01, 2 * turn[3], 5e-5);
}

/// 1 kg on a slide, pushed by 1 N for 1 s.
TEST(WorldTest, EffortsOnJointsOfObjectsActForExactlyTheirTicks) {
  World world;
  world.addRobot(robot("panda"));
  world.addObject("rail",
                  "<body><body name='cart'><joint name='slide' type='slide' axis='1 0 0'/><geom "
                  "type='box' size='.1 .1 .1' mass='1'/></body></body>",
                  at(0, 3, 1));
  run(world, 100);  // at rest
  pushJoint(world, "slide", 1.0, 1000);
  run(world, 1000);
  EXPECT_NEAR(0.5, jointState(world, "slide").position, 1e-3);
  run(world, 100);
  EXPECT_NEAR(1.0, jointState(world, "slide").velocity, 1e-9);
  pushJoint(world, "slide", -1.0, sizes::kEndlessPush);
  run(world, 100);
  world.addObject("other", "<body pos='0 -3 9'><geom size='.1'/></body>", Pose{});
  run(world, 900);
  EXPECT_NEAR(0.0, jointState(world, "slide").velocity, 1e-9);
  endJointPushes(world, "slide");
  run(world, 100);
  EXPECT_NEAR(0.0, jointState(world, "slide").velocity, 1e-9);
  expectSentence([&] { pushJoint(world, "panda_joint4", 1.0, 1); }, {"panda_joint4", "controller"});
  expectSentence([&] { pushJoint(world, "moon", 1.0, 1); }, {"moon"});
}

}  // namespace
}  // namespace franka_sim::test
