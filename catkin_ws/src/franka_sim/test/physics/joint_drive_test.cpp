// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>
#include <source_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "test_support.h"

namespace franka_sim::test {
namespace {

constexpr double kWeight = 12 * 9.81;  ///< of the lift's load [N]

class JointDriveTest : public ::testing::Test {
 protected:
  JointDriveTest() {
    RobotDescription description;
    description.name = "lift_and_wheel";
    description.urdf = franka_test::readSource("franka_sim/test/physics/data/lift_and_wheel.urdf");
    description.initial_positions["lift"] = 0.5;
    world_.addRobot(description);
    lift_ = &world_.drive("lift_and_wheel", "lift");
    wheel_ = &world_.drive("lift_and_wheel", "wheel_joint1");
  }

  void step(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      world_.step();
    }
  }

  World world_;
  JointDrive *lift_{nullptr}, *wheel_{nullptr};
};

TEST_F(JointDriveTest, AppliesEfforts) {
  lift_->applyEffort(kWeight + 1.2);
  step(1000);
  // A constant acceleration of 1.2 N / 12 kg; Euler steps lead by half a step.
  EXPECT_NEAR(0.1, lift_->measure().velocity, 1e-9);
  EXPECT_NEAR(0.5 + 0.05, lift_->measure().position, 1e-4);
  EXPECT_NEAR(kWeight + 1.2, lift_->measure().effort, 1e-9);
}

TEST_F(JointDriveTest, HoldsAPositionUnderAnyLoad) {
  lift_->follow(0.5);
  step(500);
  EXPECT_NEAR(0.5, lift_->measure().position, 1e-5);
  EXPECT_NEAR(kWeight, lift_->measure().effort, 1e-3);
  pushBody(world_, "platform", {0, 0, -500}, {0, 0, 0}, 500);
  step(500);
  EXPECT_NEAR(0.5, lift_->measure().position, 1e-4);
  EXPECT_NEAR(kWeight + 500, lift_->measure().effort, 1e-2);
}

TEST_F(JointDriveTest, FollowsASteadyMotionWithFourMillisecondsLag) {
  const double v = 0.2;
  double target = 0.5;
  for (int i = 0; i < 500; ++i) {
    target += v * World::kTick;
    lift_->follow(target);
    world_.step();
  }
  EXPECT_NEAR(v, lift_->measure().velocity, 1e-6);
  EXPECT_NEAR(target - v * 0.004, lift_->measure().position, v * 0.001);
}

TEST_F(JointDriveTest, YieldsBeyondItsMaximumEffortAndReturns) {
  lift_->follow(0.5, {kWeight + 20, 0.2});
  step(500);
  EXPECT_NEAR(0.5, lift_->measure().position, 1e-5);
  EXPECT_NEAR(kWeight, lift_->measure().effort, 1e-3);
  pushBody(world_, "platform", {0, 0, -50}, {0, 0, 0}, 100);
  step(100);
  EXPECT_NEAR(0.5 - 0.5 * 30.0 / 12.0 * 0.01, lift_->measure().position, 1e-3);
  EXPECT_NEAR(kWeight + 20, lift_->measure().effort, 1e-6);
  double highest = 0.0, fastest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    step(1);
    highest = std::max(highest, lift_->measure().position);
    fastest = std::max(fastest, lift_->measure().velocity);
  }
  EXPECT_NEAR(0.5, lift_->measure().position, 1e-5);
  EXPECT_LT(highest, 0.5 + 1e-4);
  EXPECT_LT(fastest, 0.2 + 1e-3);
}

TEST_F(JointDriveTest, PressesOnAStopWithItsMaximumEffort) {
  lift_->follow(-0.2, {30, 0.5});
  step(3000);
  EXPECT_NEAR(-30, lift_->measure().effort, 1e-6);
  EXPECT_NEAR(0.0, lift_->measure().velocity, 1e-6);
  EXPECT_GT(lift_->measure().position, -1e-3);
  EXPECT_TRUE(lift_->follow(0.1));
  step(500);
  EXPECT_NEAR(0.1, lift_->measure().position, 1e-5);
}

TEST_F(JointDriveTest, NeedsNoMoreThanItsMaximumEffortForARamp) {
  const DriveLimits limits{kWeight + 30, 0.2};
  double target = 0.5, highest = 0.0, fastest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    target = std::min(0.7, target + 0.2 * World::kTick);
    lift_->follow(target, limits);
    step(1);
    highest = std::max(highest, lift_->measure().position);
    fastest = std::max(fastest, lift_->measure().velocity);
    ASSERT_LE(lift_->measure().effort, limits.effort + 1e-6);
  }
  EXPECT_NEAR(0.7, lift_->measure().position, 1e-5);
  EXPECT_LT(highest, 0.7 + 1e-3);
  EXPECT_LT(fastest, 0.2 + 1e-3);
}

TEST_F(JointDriveTest, IsTheSameWhereTheMaximumEffortSuffices) {
  const auto positions = [this](const DriveLimits& limits) {
    world_.reset();
    std::vector<double> result;
    for (int i = 0; i < 500; ++i) {
      lift_->follow(0.5 + 0.05 * (1 - std::cos(0.01 * i)), limits);
      step(1);
      result.push_back(lift_->measure().position);
    }
    return result;
  };
  const std::vector<double> unlimited = positions({});
  EXPECT_EQ(unlimited, positions({kWeight + 300, 1.0}));
  EXPECT_EQ(unlimited, positions({0.0, 0.0})) << "a limit of 0 is none";
  EXPECT_EQ(unlimited, positions({std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_NE(unlimited, positions({kWeight + 1, 0.5}));
}

TEST_F(JointDriveTest, RepeatsALimitedMotionFromASnapshot) {
  lift_->follow(0.9, {kWeight + 20, 0.2});
  step(50);
  const Snapshot snapshot = world_.snapshot();
  step(50);
  const double position = lift_->measure().position;
  lift_->follow(0.9);
  step(50);
  EXPECT_NE(position, lift_->measure().position);
  world_.restore(snapshot);
  step(50);
  EXPECT_EQ(position, lift_->measure().position);
}

TEST_F(JointDriveTest, UsesFrictionAndDampingOfTheUrdf) {
  lift_->follow(0.5);
  wheel_->applyEffort(1.2);
  step(500);  // 25 time constants I / d
  EXPECT_NEAR((1.2 - 0.2) / 0.5, wheel_->measure().velocity, 1e-6);
  wheel_->applyEffort(0.19);
  step(500);
  // Below the dry friction, at which MuJoCo creeps: the damping alone would allow 0.38 rad/s.
  EXPECT_LT(wheel_->measure().velocity, 0.02);
}

TEST_F(JointDriveTest, HoldsWhenObjectsAreAddedOrMoved) {
  lift_->follow(0.5);
  step(100);
  world_.addRobot(robot("panda"));
  step(100);
  EXPECT_NEAR(0.5, lift_->measure().position, 1e-5);
  setJointPosition(world_, "lift", 0.8);
  step(100);
  EXPECT_NEAR(0.8, lift_->measure().position, 1e-5);

  const Snapshot snapshot = world_.snapshot();
  lift_->applyEffort(0.0);
  step(100);
  EXPECT_LT(lift_->measure().position, 0.78);
  world_.restore(snapshot);
  step(100);
  EXPECT_NEAR(0.8, lift_->measure().position, 1e-5);
  world_.reset();
  step(100);
  EXPECT_LT(lift_->measure().position, 0.48) << "nothing holds it after a reset";
}

TEST_F(JointDriveTest, IgnoresNonFiniteCommands) {
  lift_->follow(0.5);
  lift_->follow(std::numeric_limits<double>::quiet_NaN());
  wheel_->applyEffort(std::numeric_limits<double>::infinity());
  step(100);
  EXPECT_NEAR(0.5, lift_->measure().position, 1e-5);
  EXPECT_EQ(0.0, wheel_->measure().velocity);
}

/// Descriptions of 2018 give a hand's fingers position interfaces: they are joints as others.
TEST_F(JointDriveTest, DrivesFingersAndReportsWhatItCannotHold) {
  world_.addRobot(robot("panda"));
  JointDrive& leader = world_.drive("panda", "panda_finger_joint1");
  JointDrive& follower = world_.drive("panda", "panda_finger_joint2");
  EXPECT_FALSE(follower.follow(0.01)) << "a mimic joint";
  EXPECT_FALSE(leader.follow(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(leader.follow(0.03));
  step(500);
  EXPECT_NEAR(0.03, leader.measure().position, 1e-4);
  EXPECT_NEAR(0.03, follower.measure().position, 1e-3);
}

/// Only physics that a description states replaces <dynamics>, not the names of its joints.
TEST(JointDriveNames, DoNotSwitchFrictionOff) {
  std::string others;
  for (int i = 2; i <= 7; ++i) {
    const std::string name = "wheel_joint" + std::to_string(i);
    others += "<link name='of_" + name +
              "'><inertial><mass value='0.1'/><inertia ixx='0.001' iyy='0.001' izz='0.001' "
              "ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='" +
              name + "' type='continuous'><parent link='platform'/><child link='of_" + name +
              "'/><axis xyz='0 0 1'/></joint>";
  }
  RobotDescription description;
  description.name = "machine";
  description.urdf =
      replaceAll(franka_test::readSource("franka_sim/test/physics/data/lift_and_wheel.urdf"),
                 "</robot>", others + "</robot>");
  World world;
  world.addRobot(description);
  JointDrive& wheel = world.drive("machine", "wheel_joint1");
  ASSERT_TRUE(world.drive("machine", "lift").follow(0.5));
  wheel.applyEffort(1.2);
  run(world, 500);
  EXPECT_NEAR((1.2 - 0.2) / 0.5, wheel.measure().velocity, 1e-6);
}

TEST_F(JointDriveTest, OnlyMovingJointsHaveADrive) {
  EXPECT_THROW(world_.drive("lift_and_wheel", "elevator"), std::runtime_error);
  EXPECT_THROW(world_.drive("elevator", "lift"), std::runtime_error);
}

}  // namespace
}  // namespace franka_sim::test
