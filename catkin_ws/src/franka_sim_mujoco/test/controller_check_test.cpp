// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Which resources controllers may claim together.

#include "controller_check.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "sentences.h"

namespace franka_sim_mujoco {
namespace {

hardware_interface::ControllerInfo controller(const std::string& interface,
                                              const std::set<std::string>& resources) {
  hardware_interface::ControllerInfo info;
  info.name = "c";
  info.claimed_resources.emplace_back("hardware_interface::" + interface, resources);
  return info;
}

const std::set<std::string> kArm{"a_joint1", "a_joint2", "a_joint3", "a_joint4",
                                 "a_joint5", "a_joint6", "a_joint7"};
const std::set<std::string> kHand{"a_finger_joint1", "a_finger_joint2"};

TEST(ControllerCheck, AcceptsWholeArmsAndWholeHands) {
  std::set<std::string> six = kArm, both = kArm, with_wheel = kArm;
  six.erase("a_joint4");
  both.insert(kHand.begin(), kHand.end());
  with_wheel.insert("wheel");
  for (const char* interface :
       {"EffortJointInterface", "PositionJointInterface", "VelocityJointInterface"}) {
    EXPECT_EQ("", whyRefused(controller(interface, kArm), "a"));
    EXPECT_EQ("", whyRefused(controller(interface, {}), "a"));
    EXPECT_NE("", whyRefused(controller(interface, six), "a"));
    EXPECT_NE("", whyRefused(controller(interface, both), "a"));
    EXPECT_NE("", whyRefused(controller(interface, kArm), "b"));
    EXPECT_NE("", whyRefused(controller(interface, {"a_finger_joint1"}), "a"));
    EXPECT_NE("", whyRefused(controller(interface, with_wheel), "a"));
    EXPECT_EQ("", whyRefused(controller(interface, with_wheel), "a", {"wheel"}));
    EXPECT_EQ("", whyRefused(controller(interface, {"wheel"}), "a", {"wheel"}));
  }
  EXPECT_EQ("", whyRefused(controller("EffortJointInterface", kHand), "a"));
  EXPECT_TRUE(contains(whyRefused(controller("PositionJointInterface", kHand), "a"),
                       "PositionJointInterface"));
  EXPECT_EQ("", whyRefused(controller("PositionJointInterface", kHand), "a", kHand));
  EXPECT_TRUE(contains(whyRefused(controller("OtherInterface", kArm), "a"), "OtherInterface"));
  hardware_interface::ControllerInfo pose = controller("", {"a_robot"});
  pose.claimed_resources.front().hardware_interface = "franka_hw::FrankaPoseCartesianInterface";
  EXPECT_EQ("", whyRefused(pose, "a"));
  EXPECT_TRUE(contains(whyRefused(pose, "b"), "b_robot"));
}

TEST(ControllerCheck, DeterminesTheClaimedMode) {
  using franka_hw::ControlMode;
  hardware_interface::ControllerInfo pose = controller("EffortJointInterface", kArm);
  pose.claimed_resources.emplace_back("franka_hw::FrankaPoseCartesianInterface",
                                      std::set<std::string>{"a_robot"});
  EXPECT_EQ(ControlMode::JointTorque | ControlMode::CartesianPose, claimedMode({pose}, "a"));
  EXPECT_EQ(ControlMode::None, claimedMode({pose}, "panda"));
  EXPECT_EQ(ControlMode::None, claimedMode({controller("EffortJointInterface", kHand)}, "a"));
  EXPECT_EQ(ControlMode::JointVelocity,
            claimedMode({controller("VelocityJointInterface", kArm)}, "a"));
  EXPECT_TRUE(commandsArm(pose, "a"));
  EXPECT_FALSE(commandsArm(controller("EffortJointInterface", kHand), "a"));
}

TEST(ControllerCheck, ConflictsMatchTheRobot) {
  const auto effort = controller("EffortJointInterface", kArm);
  const auto position = controller("PositionJointInterface", kArm);
  const auto velocity = controller("VelocityJointInterface", kArm);
  const auto wheel = controller("VelocityJointInterface", {"wheel"});
  hardware_interface::ControllerInfo pose = controller("", {"a_robot"});
  pose.claimed_resources.front().hardware_interface = "franka_hw::FrankaPoseCartesianInterface";
  const auto hand = controller("EffortJointInterface", kHand);
  EXPECT_FALSE(conflict({effort, position, hand, wheel}, "a"));
  EXPECT_FALSE(conflict({effort, pose}, "a"));
  EXPECT_TRUE(conflict({effort, effort}, "a"));
  EXPECT_TRUE(conflict({position, velocity}, "a"));
  EXPECT_TRUE(conflict({position, pose}, "a"));
  EXPECT_TRUE(conflict({pose, pose}, "a"));
  EXPECT_TRUE(conflict({hand, hand}, "a"));
  EXPECT_TRUE(conflict({wheel, wheel}, "a"));
}

}  // namespace
}  // namespace franka_sim_mujoco
