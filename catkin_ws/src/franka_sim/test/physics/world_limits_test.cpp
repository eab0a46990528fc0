// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Numbers beyond any robot are refused; a world that diverges nevertheless stops, reports why, and
/// can be reset; overlaps of a new robot are reported.

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_gravity.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>

#include <limits>
#include <string>
#include <vector>

#include "physics/world/world_impl.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Light enough that a permitted force makes it diverge.
constexpr char kFeather[] =
    R"(<body name="feather"><freejoint name="feather_joint"/>
         <inertial pos="0 0 0" mass="1e-7" diaginertia="1e-7 1e-7 1e-7"/>
         <geom type="sphere" size="0.01"/></body>)";

/// A wheel without stops.
constexpr char kWheel[] =
    R"(<body name="wheel"><joint name="axle" type="hinge" axis="0 0 1"/>
         <geom type="cylinder" size="0.05 0.01" mass="0.1"/></body>)";

constexpr char kCrate[] =
    R"(<body name="crate"><freejoint/><geom type="box" size="0.1 0.1 0.1" mass="1"/></body>)";

struct Entrance {
  const char* name;
  const char* unit;
  double largest;  ///< accepted number
  void (*put)(World& world, double size);
};

const Entrance kEntrances[] = {
    {"place", " m", 1e3, [](World& w, double size) { setBodyPose(w, "stone", at(size, 0, 1)); }},
    {"place down", " m", 1e3,
     [](World& w, double size) { setBodyPose(w, "stone", at(0, 0, -size)); }},
    {"push", " N", 1e4, [](World& w, double size) { pushBody(w, "stone", {0, size, 0}, {}, 1); }},
    {"push torque", " Nm", 1e4,
     [](World& w, double size) { pushBody(w, "stone", {}, {size, 0, 0}, 1); }},
    {"push at", " N", 1e4,
     [](World& w, double size) { pushBody(w, "stone", {0, 0, size}, {}, 1, {{0, 0, 0}}); }},
    {"push point", " m", 1e3,
     [](World& w, double size) { pushBody(w, "stone", {}, {}, 1, {{size, 0, 0}}); }},
    {"linear velocity", " m/s", 1e3,
     [](World& w, double size) { setBodyTwist(w, "stone", {{size, 0, 0}, {}}); }},
    {"angular velocity", " rad/s", 1e3,
     [](World& w, double size) { setBodyTwist(w, "stone", {{}, {0, 0, size}}); }},
    {"pose and velocity", " rad/s", 1e3,
     [](World& w, double size) { setBodyState(w, "stone", {at(1, 0, 1), {{}, {0, 0, size}}}); }},
    {"joint position", " rad", 1e3,
     [](World& w, double size) { setJointPosition(w, "axle", size); }},
    {"joint velocity", " rad/s", 1e3,
     [](World& w, double size) { setJointVelocity(w, "axle", size); }},
    {"gravity", " m/s^2", 1e2, [](World& w, double size) { setGravity(w, {0, 0, -size}); }},
    {"object", " m", 1e3,
     [](World& w, double size) { w.addObject("other", kCrate, at(size, 0, 9)); }},
    {"robot", " m", 1e3,
     [](World& w, double size) {
       RobotDescription description = robot("panda");
       description.base = at(0, size, 0);
       w.addRobot(description);
     }},
};

class Sizes : public ::testing::TestWithParam<Entrance> {};

TEST_P(Sizes, BeyondTheLimitsAreRefusedWithASentence) {
  const Entrance& entrance = GetParam();
  World world(test::world("stone"));
  world.addObject("turner", kWheel, at(3, 3, 1));
  const std::uint64_t hash = world.stateHash();
  for (const double size : {kNan, kInf, -kInf, 1e308, 1e12, -1e11, 1.001 * entrance.largest,
                            -1.001 * entrance.largest}) {
    SCOPED_TRACE(size);
    expectSentence([&] { entrance.put(world, size); }, {entrance.unit});
    EXPECT_EQ(hash, world.stateHash()) << "nothing changes";
  }
  EXPECT_NO_THROW(entrance.put(world, entrance.largest));
  // Light bodies may still diverge: then with a sentence.
  for (std::uint64_t k = 1; k <= 20; k++) {
    world.step();
    ASSERT_EQ(world.stopped(), !world.fault().empty());
    ASSERT_TRUE(world.stopped() || world.ticks() == k);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Sizes, ::testing::ValuesIn(kEntrances), [](const auto& info) {
  std::string name = info.param.name;
  for (char& letter : name) {
    letter = letter == ' ' ? '_' : letter;
  }
  return name;
});

TEST(Divergence, StopsTheWorldUntilAReset) {
  World world(test::world("stone"));
  world.addObject("feather", kFeather, at(5, 5, 5));
  run(world, 10);
  const Pose stone = bodyPose(world, "stone"), feather = bodyPose(world, "feather");
  EXPECT_FALSE(world.stopped());
  EXPECT_EQ("", world.fault());
  pushBody(world, "feather", {1e4, 0, 0}, {}, 5);
  for (const bool prepared : {true, false}) {
    if (prepared) {
      world.prepareStep();
    }
    world.step();
    EXPECT_TRUE(world.stopped());
    EXPECT_EQ(10u, world.ticks()) << "time stands still";
    EXPECT_EQ(stone.position, bodyPose(world, "stone").position) << "and nothing was reset";
    EXPECT_EQ(feather.position, bodyPose(world, "feather").position);
  }
  const std::string fault = world.fault();
  EXPECT_NE(std::string::npos, fault.find("acceleration of body 'feather")) << fault;
  EXPECT_NE(std::string::npos, fault.find("until it is reset")) << fault;
  expectSentence([&] { setBodyPose(world, "stone", at(0, 0, 1)); }, {"diverged", "feather"});
  expectSentence([&] { pushBody(world, "stone", {}, {}, 1); }, {"diverged"});
  expectSentence([&] { world.snapshot(); }, {"diverged"});
  world.removeObject("feather");
  EXPECT_EQ(fault, world.fault()) << "even after its body was removed";
  world.reset();
  EXPECT_FALSE(world.stopped());
  world.step();
  EXPECT_EQ(1u, world.ticks());
}

TEST(Divergence, OfAWorldFileIsDetectedBeforeTheFirstStep) {
  World world;
  world.addObject("far", R"(<mujoco><worldbody><body name="far" pos="1e11 0 0"><freejoint/>
      <geom type="sphere" size="0.1" mass="1"/></body></worldbody></mujoco>)",
                  at(0, 0, 0));
  world.prepareStep();
  world.step();
  EXPECT_TRUE(world.stopped());
  EXPECT_NE(std::string::npos, world.fault().find("position of body 'far")) << world.fault();
}

TEST(Pushes, AreLimitedInDurationAndNumber) {
  World world(test::world("stone"));
  expectSentence([&] { pushBody(world, "stone", {0, 0, 1}, {}, 1000001); }, {"stone", "1000000"});
  for (int i = 0; i < 1000; i++) {
    pushBody(world, "stone", {0, 0, 0}, {}, 1);
  }
  expectSentence([&] { pushBody(world, "stone", {0, 0, 1}, {}, 1, {{0, 0, 0}}); }, {"1000 pushes"});
  world.step();
  pushBody(world, "stone", {0, 0, 1}, {}, 1000000);
}

TEST(Divergence, EndsWhenASnapshotIsRestored) {
  World world(test::world("stone"));
  world.addObject("feather", kFeather, at(5, 5, 5));
  const Snapshot before = world.snapshot();
  pushBody(world, "feather", {0, 0, 1e4}, {}, 5);
  world.step();
  ASSERT_TRUE(world.stopped());
  world.restore(before);
  EXPECT_FALSE(world.stopped());
  run(world, 10);
  EXPECT_EQ(10u, world.ticks());
}

TEST(Divergence, KeepsMeasurementsOfRobotsFinite) {
  World world;
  world.addRobot(robot("panda"));
  ArmPlant& arm = world.arm("panda", "panda");
  std::array<double, 7> torques;
  torques.fill(1e300);
  arm.applyTorques(torques);
  world.step();
  EXPECT_TRUE(world.stopped());
  for (int i = 0; i < 7; i++) {
    EXPECT_EQ(kHome[static_cast<std::size_t>(i)], arm.measure().q[static_cast<std::size_t>(i)]);
    EXPECT_EQ(0.0, arm.measure().dq[static_cast<std::size_t>(i)]);
  }
}

TEST(Warnings, OfMujocoAreReportedOnce) {
  // Room for one contact, and four spheres on the ground.
  std::string bodies;
  for (int i = 0; i < 4; i++) {
    bodies += R"(<body pos=")" + std::to_string(i) +
              R"( 0 0.099"><freejoint/><geom type="sphere" size="0.1" mass="1"/></body>)";
  }
  const franka_test::TemporaryFolder folder;
  World world(folder.write("narrow.xml", R"(<mujoco><size nconmax="1" njmax="50"/><worldbody>)"
                                         R"(<geom type="plane" size="9 9 0.1"/>)" +
                                             bodies + "</worldbody></mujoco>"));
  EXPECT_TRUE(world.takeWarnings().empty());
  world.step();
  const std::vector<std::string> warnings = world.takeWarnings();
  ASSERT_EQ(1u, warnings.size());
  EXPECT_NE(std::string::npos, warnings[0].find("nconmax")) << warnings[0];
  world.step();
  EXPECT_TRUE(world.takeWarnings().empty());
  EXPECT_FALSE(world.stopped());
}

/// @param columns boxes of 4 cm side by side, before the next row begins
std::string boxesOnTheGround(int count, int columns) {
  std::string bodies;
  for (int i = 0; i < count; i++) {
    const int row = i / columns;
    bodies += "<body name='box" + std::to_string(i) + "' pos='" +
              franka_core::numberText(0.1 * (i % columns)) + " " +
              franka_core::numberText(0.1 * row) + " 0.02'><freejoint/>" +
              "<geom type='box' size='0.02 0.02 0.02' mass='0.05'/></body>";
  }
  return "<mujoco><worldbody><geom type='plane' size='9 9 0.1'/>" + bodies +
         "</worldbody></mujoco>";
}

/// More constraints than MuJoCo has room for: the contacts of a box share their friction, so that
/// all of them press. A box that falls would be 20 mm lower.
TEST(WorldContactCapacity, HoldsAThousandBoxesBesideARobot) {
  const franka_test::TemporaryFolder folder;
  World world(folder.write("boxes.xml", boxesOnTheGround(1000, 32)));
  RobotDescription description = robot("panda");
  description.base = at(-2, 0, 0);
  world.addRobot(description);
  run(world, 64);
  EXPECT_TRUE(world.takeWarnings().empty());
  EXPECT_EQ(4000u, contacts(world).size());
  for (int i = 0; i < 1000; i++) {
    ASSERT_NEAR(0.02, bodyPose(world, "box" + std::to_string(i)).position[2], 5e-4) << i;
  }
}

/// Boxes of the robot's own description that lie on the ground, each on a joint of its own.
TEST(WorldContactCapacity, HoldsARobotOfManyShapes) {
  constexpr int kBoxes = 60;
  RobotDescription description;
  description.name = "rack";
  description.urdf = "<robot name='rack'><link name='world'/>";
  for (int i = 0; i < kBoxes; i++) {
    const std::string n = std::to_string(i);
    const int row = i / 10;
    description.urdf +=
        "<link name='box" + n +
        "'><inertial><mass value='0.1'/><inertia ixx='1e-4' iyy='1e-4' izz='1e-4' ixy='0' ixz='0'"
        " iyz='0'/></inertial><collision><geometry><box size='0.04 0.04 0.04'/></geometry>"
        "</collision></link><joint name='joint" +
        n + "' type='prismatic'><parent link='world'/><child link='box" + n + "'/><origin xyz='" +
        franka_core::numberText(0.1 * (i % 10)) + " " + franka_core::numberText(0.1 * row) +
        " 0.02'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='9' velocity='9'/></joint>";
  }
  description.urdf += "</robot>";
  const franka_test::TemporaryFolder folder;
  World world(folder.write("ground.xml", boxesOnTheGround(0, 1)));
  world.addRobot(description);
  run(world, 300);
  EXPECT_TRUE(world.takeWarnings().empty());
  EXPECT_EQ(4u * kBoxes, contacts(world).size());
  for (int i = 0; i < kBoxes; i++) {
    ASSERT_NEAR(0.02, bodyPose(world, "box" + std::to_string(i)).position[2], 5e-4) << i;
  }
}

/// Two arms of one description have as much room as two robots.
TEST(WorldContactCapacity, OfTwoArmsInOneDescriptionIsThatOfTwoRobots) {
  World apart, together;
  apart.addRobot(robot("panda", "left"));
  apart.addRobot(robot("panda", "right"));
  together.addRobot(twoArms());
  const mjModel& expected = *implOf(apart).model;
  const mjModel& found = *implOf(together).model;
  EXPECT_GE(found.nconmax, expected.nconmax);
  EXPECT_GE(found.njmax, expected.njmax);
  EXPECT_LT(found.njmax, 2 * expected.njmax) << "its square is memory";
}

TEST(Overlaps, AreReportedForARobotThatStartsInTheTable) {
  World world(test::world("stone"));
  world.addRobot(robot("fr3"));
  const std::string text = describeOverlaps(world, "fr3");
  EXPECT_NE(std::string::npos, text.find("fr3_link1 and table by ")) << text;
  EXPECT_NE(std::string::npos, text.find("'fr3'")) << text;
  world.removeRobot("fr3");
  RobotDescription beside = robot("fr3");
  beside.base = at(-0.5, 0, 0);
  world.addRobot(beside);
  EXPECT_EQ("", describeOverlaps(world, "fr3"));
  RobotDescription other = robot("panda");
  other.base = at(-0.45, 0.05, 0);
  world.addRobot(other);
  EXPECT_NE(std::string::npos, describeOverlaps(world, "panda").find("fr3_link"));
}

}  // namespace
}  // namespace franka_sim::test
