// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_gravity.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>

#include <cmath>

#include "test_support.h"

namespace franka_sim::test {
namespace {

/// A pendulum that stands out horizontally, of a link of 2 kg and one of 1 kg that is fixed to it.
RobotDescription pendulum(const std::string& settings) {
  const auto link = [](const std::string& name, const std::string& mass, const std::string& x) {
    return "<link name='" + name + "'><inertial><origin xyz='" + x + " 0 0'/><mass value='" + mass +
           "'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' "
           "iyz='0'/></inertial></link>";
  };
  RobotDescription description;
  description.name = "rod";
  description.urdf =
      "<robot name='rod'><link name='world'/>" + link("rod", "2", "0.3") + link("bob", "1", "0.3") +
      "<joint name='swing' type='revolute'><parent link='world'/><child link='rod'/>"
      "<origin xyz='0 0 2'/><axis xyz='0 1 0'/><limit lower='-3' upper='3' effort='9' "
      "velocity='9'/>"
      "</joint><joint name='weld' type='fixed'><parent link='rod'/><child link='bob'/>"
      "<origin xyz='0.3 0 0'/></joint>" +
      settings + "</robot>";
  return description;
}

std::string off(const std::string& link, const std::string& how = "<gravity>false</gravity>") {
  return "<gazebo reference='" + link + "'>" + how + "</gazebo>";
}

double angleAfter(World& world, int ticks) {
  run(world, ticks);
  return jointState(world, "swing").position;
}

TEST(LinksWithoutGravity, DoNotPullTheirJoint) {
  for (const std::string& settings :
       {off("rod") + off("bob"), off("rod", "<turnGravityOff>true</turnGravityOff>") +
                                     off("bob", "<turnGravityOff>1</turnGravityOff>")}) {
    World world;
    world.addRobot(pendulum(settings));
    EXPECT_NEAR(0.0, angleAfter(world, 1000), 1e-9);
    setGravity(world, {0, 0, -1.62});
    EXPECT_NEAR(0.0, angleAfter(world, 1000), 1e-9);
    EXPECT_FALSE(bodyInertia(world, "rod").gravity);
  }
}

// The torque of what is left, over the whole inertia, at the begin of the fall.
TEST(LinksWithoutGravity, LeaveTheWeightOfThoseThatAreFixedToThem) {
  constexpr double kInertia = 2 * 0.3 * 0.3 + 0.01 + 1 * 0.6 * 0.6 + 0.01;
  const auto falls = [](const std::string& settings, double torque) {
    World world;
    world.addRobot(pendulum(settings));
    constexpr int kTicks = 20;
    const double expected = 0.5 * torque / kInertia * std::pow(kTicks * kTick, 2);
    EXPECT_NEAR(expected, angleAfter(world, kTicks), 0.06 * expected + 1e-9) << settings;
  };
  falls("", 9.81 * (2 * 0.3 + 1 * 0.6));
  falls(off("rod"), 9.81 * 1 * 0.6);
  falls(off("bob"), 9.81 * 2 * 0.3);
}

TEST(LinksWithoutGravity, OfAnObjectFloatAndAccelerateAsTheirMass) {
  const auto box = [](const std::string& name, const std::string& settings) {
    return "<sdf version='1.6'><model name='" + name + "'><link name='l'>" + settings +
           "<inertial><mass>2</mass></inertial></link></model></sdf>";
  };
  World world;
  world.addObject("balloon", box("balloon", "<gravity>false</gravity>"), at(0, 0, 50));
  world.addObject(
      "kite",
      "<robot name='kite'><link name='l'><inertial><mass value='2'/><inertia ixx='0.01' "
      "iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial></link>" +
          off("l") + "</robot>",
      at(6, 0, 50));
  world.addObject("stone", box("stone", ""), at(3, 0, 50));
  EXPECT_FALSE(bodyInertia(world, "balloon").gravity);
  EXPECT_TRUE(bodyInertia(world, "stone").gravity);
  run(world, 1000);
  EXPECT_NEAR(50.0, bodyPose(world, "balloon").position[2], 1e-9);
  EXPECT_NEAR(50.0, bodyPose(world, "kite").position[2], 1e-9);
  EXPECT_NEAR(50.0 - 0.5 * 9.81, bodyPose(world, "stone").position[2], 0.01);
  pushBody(world, "balloon", {4, 0, 0}, {0, 0, 0}, 1000);
  run(world, 1000);
  EXPECT_NEAR(2.0, bodyState(world, "balloon").twist.linear[0], 1e-6);
  run(world, 1000);
  EXPECT_NEAR(50.0, bodyPose(world, "balloon").position[2], 1e-9);
}

}  // namespace
}  // namespace franka_sim::test
