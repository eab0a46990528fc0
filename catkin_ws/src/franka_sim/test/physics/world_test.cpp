// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <fstream>

#include "physics/compile.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

void run(World* world, int ticks) {
  for (int k = 0; k < ticks; ++k) {
    world->step();
  }
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(WorldTest, EmptyWorldHasGravityAndTime) {
  World world;
  EXPECT_EQ((std::array<double, 3>{0, 0, -9.81}), world.gravity());
  run(&world, 10);
  EXPECT_EQ(10u, world.ticks());
  EXPECT_DOUBLE_EQ(0.01, world.time());
  EXPECT_TRUE(world.robots().empty());
}

TEST(WorldTest, EmptyWorldFileCompiles) {
  World world(test::world("empty"));
  world.addRobot(robot("panda"));
  EXPECT_EQ(std::vector<std::string>{"panda"}, world.robots());
}

/// The stone neither sinks nor creeps nor vibrates on its tray.
TEST(WorldTest, StoneRestsOnTheBlueTray) {
  World world(test::world("stone"));
  run(&world, 1000);
  const Pose before = world.bodyPose("stone");
  double highest_speed = 0;
  Pose last = before;
  for (int k = 0; k < 20000; ++k) {
    world.step();
    const Pose now = world.bodyPose("stone");
    highest_speed = std::max(highest_speed, distance(now.position, last.position) / World::kTick);
    last = now;
  }
  EXPECT_LT(distance(before.position, last.position), 1e-6);
  EXPECT_LT(highest_speed, 1e-6);
  // Tray top and half the stone, from the numbers of the world: at most 0.1 mm of give.
  EXPECT_NEAR(0.419773 + 0.023348 + 0.032, last.position[2], 1e-4);
  EXPECT_NEAR(1.0, std::abs(last.orientation[0]), 1e-6);
}

TEST(WorldTest, ContactForcesCarryTheStone) {
  World world(test::world("stone"));
  run(&world, 1000);
  double up = 0;
  for (const Contact& contact : world.contacts()) {
    ASSERT_TRUE((contact.body1 == "pick_tray" && contact.body2 == "stone") ||
                (contact.body1 == "stone" && contact.body2 == "pick_tray"));
    up += contact.body2 == "stone" ? contact.force[2] : -contact.force[2];
  }
  EXPECT_NEAR(0.1024 * 9.81, up, 1e-6);
}

TEST(WorldTest, StoneCanBeMovedToTheRedTray) {
  World world(test::world("stone"));
  Pose pose;
  pose.position = {0.004103, 0.219654, 0.5};
  pose.orientation = {std::cos(0.3), 0, 0, std::sin(0.3)};
  world.setBodyPose("stone", pose);
  const Pose read = world.bodyPose("stone");
  EXPECT_LT(distance(pose.position, read.position), 1e-15);
  EXPECT_NEAR(std::sin(0.3), read.orientation[3], 1e-15);
  run(&world, 2000);
  EXPECT_NEAR(0.419764 + 0.023348 + 0.032, world.bodyPose("stone").position[2], 1e-4);
  EXPECT_NEAR(0.219654, world.bodyPose("stone").position[1], 1e-3);
}

/// The smaller friction of two surfaces decides: 0.6 of the stone, not 1 of the table.
TEST(WorldTest, SmallerFrictionDecides) {
  for (const double ratio : {0.5, 0.75}) {
    World world(test::world("stone"));
    Pose pose;
    pose.position = {0.0, 0.0, 0.4198 + 0.0125};
    pose.orientation = {std::cos(M_PI / 4), 0, std::sin(M_PI / 4),
                        0};  // lying, so that it does not tip over
    world.setBodyPose("stone", pose);
    run(&world, 500);
    const Pose before = world.bodyPose("stone");
    world.push("stone", {0, ratio * 0.1024 * 9.81, 0}, {}, 300);
    run(&world, 300);
    const double moved = distance(before.position, world.bodyPose("stone").position);
    if (ratio < 0.6) {
      EXPECT_LT(moved, 1e-4);
    } else {
      EXPECT_GT(moved, 1e-2);
    }
  }
}

TEST(WorldTest, TwoArmsOfAnyNameWorkSideBySide) {
  World world;
  RobotDescription left = robot("panda", "left");
  left.base.position = {0, 0.5, 0};
  RobotDescription right = robot("fr3", "right");
  right.base.position = {0, -0.5, 0};
  world.addRobot(left);
  world.addRobot(right);
  EXPECT_EQ((std::vector<std::string>{"left", "right"}), world.robots());
  ArmHolder left_holder(&world.arm("left", "left"), "panda");
  ArmHolder right_holder(&world.arm("right", "right"), "fr3");
  for (int k = 0; k < 2000; ++k) {
    left_holder.hold(kHome);
    right_holder.hold(kHome);
    world.step();
  }
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(kHome[i], world.arm("left", "left").measure().q[i], 1e-5);
    EXPECT_NEAR(kHome[i], world.arm("right", "right").measure().q[i], 1e-5);
  }
  EXPECT_NEAR(1.0,
              world.bodyPose("left_hand").position[1] - world.bodyPose("right_hand").position[1],
              1e-4);
}

TEST(WorldTest, LinkPosesMatchArmModel) {
  World world;
  RobotDescription description = robot("panda");
  description.base.position = {0.3, -0.2, 0.1};
  description.base.orientation = {std::cos(0.5), 0, 0, std::sin(0.5)};
  world.addRobot(description);
  const auto model = franka_core::ArmModel::fromUrdf(description.urdf, "panda");
  const auto flange = model.pose(franka_core::ArmFrame::kFlange, kHome);
  const Pose link8 = world.bodyPose("panda_link8");
  EXPECT_NEAR(0.3 + std::cos(1.0) * flange[12] - std::sin(1.0) * flange[13], link8.position[0],
              1e-12);
  EXPECT_NEAR(-0.2 + std::sin(1.0) * flange[12] + std::cos(1.0) * flange[13], link8.position[1],
              1e-12);
  EXPECT_NEAR(0.1 + flange[14], link8.position[2], 1e-12);
  const Pose tcp = world.bodyPose("panda_hand_tcp");
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
    if (k == 200) {
      changing.addRobot(second);
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
    ASSERT_LT(distance(alone.bodyPose("stone").position, changing.bodyPose("stone").position),
              1e-9);
  }
  EXPECT_EQ(std::vector<std::string>{"panda"}, changing.robots());
}

TEST(WorldTest, AddingARobotChangesNoBitOfTheState) {
  World world(test::world("stone"));
  RobotDescription first = robot("panda");
  first.base.position = {-0.5, 0, 0};
  world.addRobot(first);
  ArmPlant& arm = world.arm("panda", "panda");
  const ArmHolder holder(&arm);
  for (int k = 0; k < 300; ++k) {
    arm.applyTorques(holder.torques(kHome));
    world.step();
  }
  arm.setBrakes(true);
  const std::uint64_t hash = world.stateHash();
  const ArmMeasurement before = arm.measure();
  RobotDescription second = robot("fr3", "visitor");
  second.base.position = {0, 5, 0};
  world.addRobot(second);
  EXPECT_EQ(before.q, arm.measure().q);
  EXPECT_EQ(before.dq, arm.measure().dq);
  EXPECT_EQ(before.tau_J, arm.measure().tau_J);
  world.removeRobot("visitor");
  EXPECT_EQ(hash, world.stateHash()) << "brakes, warm starts and torques included";
  EXPECT_EQ(300u, world.ticks());
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
  expectSentence([&] { world.bodyPose("ston"); }, {"no body 'ston'"});
  expectSentence([&] { world.bodyPose(""); }, {"no body ''"});
  expectSentence([&] { world.setBodyPose("table", {}); }, {"'table'", "not free"});
  expectSentence([&] { world.setBodyPose("stone", {{0, 0, NAN}, {1, 0, 0, 0}}); }, {"not finite"});
  expectSentence([&] { world.setBodyPose("stone", {{}, {0, 0, 0, 0}}); },
                 {"not a unit quaternion"});
  expectSentence([&] { world.joint("panda_joint8"); }, {"no joint 'panda_joint8'"});
  expectSentence([&] { world.joint("stone"); }, {"'stone'", "more than one degree"});
  expectSentence([&] { world.setJointPosition("panda_joint1", 9); }, {"panda_joint1", "stops"});
  expectSentence([&] { world.push("moon", {}, {}, 1); }, {"no body 'moon'"});
  expectSentence([&] { world.push("stone", {NAN, 0, 0}, {}, 1); }, {"not finite"});
}

TEST(WorldTest, JointsCanBeTeleported) {
  World world;
  world.addRobot(robot("panda"));
  ArmPlant& arm = world.arm("panda", "panda");
  arm.setBrakes(true);
  world.setJointPosition("panda_joint4", -1.5);
  EXPECT_EQ(-1.5, world.joint("panda_joint4").position);
  run(&world, 200);
  EXPECT_NEAR(-1.5, arm.measure().q[3], 1e-4) << "the brake holds the new position";
}

/// A push of 1 N for 1 s moves a stone in free fall sideways by F / (2 m) t^2.
TEST(WorldTest, PushesActForExactlyTheirTicks) {
  World world(test::world("stone"));
  Pose high;
  high.position = {5, 5, 50};
  world.setBodyPose("stone", high);
  world.push("stone", {0.1024, 0, 0}, {}, 1000);
  run(&world, 1000);
  EXPECT_NEAR(5.5, world.bodyPose("stone").position[0], 1e-3);
  run(&world, 1000);
  EXPECT_NEAR(6.5, world.bodyPose("stone").position[0], 1e-3) << "then it flies on at 1 m/s";
}

TEST(WorldTest, PushAtAPointTurnsTheBody) {
  World world(test::world("stone"));
  Pose high;
  high.position = {5, 5, 50};
  world.setBodyPose("stone", high);
  // 1e-3 N at 0.01 m from the centre about z: 1e-5 Nm on 1.407e-5 kg m^2 for 0.1 s.
  world.pushAt("stone", {5.01, 5, 50}, {0, 1e-3, 0}, 100);
  run(&world, 100);
  const auto turn = world.bodyPose("stone").orientation;
  EXPECT_NEAR(0.5 * 1e-5 / 1.407e-5 * 0.01, 2 * turn[3], 5e-5);
}

/// A push on the hand acts on the joints as J^T F.
TEST(WorldTest, PushOnTheHandIsCarriedByTheArm) {
  World world;
  world.addRobot(robot("panda"));
  ArmPlant& arm = world.arm("panda", "panda");
  const ArmHolder holder(&arm);
  world.push("panda_link8", {10, 0, 0}, {}, 3000);
  for (int k = 0; k < 3000; ++k) {
    arm.applyTorques(holder.torques(kHome));
    world.step();
  }
  const ArmMeasurement m = arm.measure();
  const auto jacobian = holder.model().zeroJacobian(franka_core::ArmFrame::kFlange, m.q);
  const auto gravity = holder.model().gravity(m.q, holder.payload());
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(gravity[i] - 10 * jacobian[6 * i], m.tau_J[i], 1e-3);
  }
}

/// The hand folded back touches the forearm (joint 6 at its lower end), and nothing touches at
/// home.
TEST(WorldTest, HandCollidesWithTheForearmButNeighboursDoNot) {
  World world;
  world.addRobot(robot("panda"));
  world.step();
  EXPECT_TRUE(world.contacts().empty());
  world.setJointPosition("panda_joint6", -0.6);
  world.setJointPosition("panda_joint1", 0.5);
  world.step();
  bool touches = false;
  for (const Contact& contact : world.contacts()) {
    const std::string both = contact.body1 + " " + contact.body2;
    touches = touches || both == "panda_hand panda_link5" || both == "panda_link5 panda_hand";
  }
  EXPECT_TRUE(touches);
}

TEST(WorldTest, ModelHasNoWeldAndNoAdhesion) {
  World world(test::world("stone"));
  world.addRobot(robot("panda"));
  const auto model = physics::compile(world.mjcf(false), "the merged model");
  for (int e = 0; e < model->neq; ++e) {
    ASSERT_EQ(mjEQ_JOINT, model->eq_type[e]);
    for (const int joint : {model->eq_obj1id[e], model->eq_obj2id[e]}) {
      ASSERT_TRUE(joint < 0 || model->jnt_type[joint] != mjJNT_FREE);
    }
  }
  EXPECT_EQ(0, model->nu) << "no actuator, so no adhesion";
  EXPECT_EQ(0, model->ntendon);
  for (int g = 0; g < model->ngeom; ++g) {
    EXPECT_EQ(0.0, model->geom_margin[g]);
    EXPECT_EQ(0.0, model->geom_gap[g]);
  }
}

}  // namespace
}  // namespace franka_sim::test
