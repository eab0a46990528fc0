// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// What a description says: whether it is that of a Panda or of an FR3, and its plugin element.

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "arm_parameters.h"
#include "plugin_element.h"
#include "sentences.h"

namespace franka_sim_mujoco {
namespace {

/// Limits of joints 1 to 7 in the manufacturer's descriptions: lower, upper [rad], velocity
/// [rad/s].
struct Limits {
  std::array<double, 7> lower, upper, velocity;
};
constexpr Limits kPandaUrdf{{{-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973}},
                            {{2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973}},
                            {{2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61}}};
constexpr Limits kFr3Urdf{{{-2.3093, -1.5133, -2.4937, -2.7478, -2.48, 0.8521, -2.6895}},
                          {{2.3093, 1.5133, 2.4937, -0.4461, 2.48, 4.2094, 2.6895}},
                          {{2.0, 1.0, 1.5, 1.25, 3.0, 1.5, 3.0}}};
constexpr Limits kFr3Ros2Urdf{{{-2.9007, -1.8361, -2.9007, -3.077, -2.8763, 0.4398, -3.0508}},
                              {{2.9007, 1.8361, 2.9007, -0.1169, 2.8763, 4.6216, 3.0508}},
                              {{2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26}}};

/// Ranges that both robots can reach; velocities are kept.
Limits narrowed(Limits limits) {
  limits.lower = {{-1.0, -1.0, -1.0, -2.5, -1.0, 1.0, -1.0}};
  limits.upper = {{1.0, 1.0, 1.0, -0.5, 1.0, 3.0, 1.0}};
  return limits;
}

Limits slowed(Limits limits) {
  limits.velocity.fill(0.5);
  return limits;
}

std::string joints(const std::string& arm_id, const Limits& limits) {
  std::ostringstream text;
  text << "<link name='" << arm_id << "_link0'/>";
  for (std::size_t i = 0; i < 7; ++i) {
    text << "<link name='" << arm_id << "_link" << i + 1 << "'/><joint name='" << arm_id << "_joint"
         << i + 1 << "' type='revolute'><parent link='" << arm_id << "_link" << i
         << "'/><child link='" << arm_id << "_link" << i + 1
         << "'/><axis xyz='0 0 1'/><limit lower='" << limits.lower[i] << "' upper='"
         << limits.upper[i] << "' velocity='" << limits.velocity[i] << "' effort='87'/></joint>";
  }
  return text.str();
}

std::string carried(const std::string& arm_id) {
  return "<joint name='" + arm_id + "_mount' type='fixed'><parent link='base'/><child link='" +
         arm_id + "_link0'/></joint>";
}

RobotType detect(const std::string& name, const std::string& parts,
                 const std::optional<std::string>& configured = {},
                 const std::string& arm_id = "arm") {
  urdf::Model urdf;
  EXPECT_TRUE(urdf.initString("<robot name='" + name + "'>" + parts + "</robot>"));
  return determineRobotType(configured, urdf, arm_id);
}

TEST(RobotType, IsDetectedByTheJointsNotByTheName) {
  for (const Limits& fr3 :
       {kFr3Urdf, kFr3Ros2Urdf, slowed(kFr3Urdf), narrowed(kFr3Urdf), narrowed(kFr3Ros2Urdf)}) {
    EXPECT_EQ("fr3", detect("my_machine", joints("arm", fr3)).name);
    EXPECT_EQ("fr3", detect("panda", joints("arm", fr3)).name);
  }
  for (const Limits& panda : {kPandaUrdf, slowed(kPandaUrdf), narrowed(kPandaUrdf)}) {
    EXPECT_EQ("panda", detect("my_machine", joints("arm", panda)).name);
    EXPECT_EQ("panda", detect("fr3", joints("arm", panda)).name);
  }
  EXPECT_TRUE(
      contains(detect("a", joints("arm", kFr3Urdf)).why, "positions that the URDF allows arm"));
  EXPECT_TRUE(contains(detect("a", joints("arm", narrowed(kFr3Urdf))).why, "velocities"));
}

TEST(RobotType, IsDetectedForEachOfSeveralArms) {
  const std::string both = "<link name='base'/>" + joints("left", kFr3Urdf) + carried("left") +
                           joints("right", kPandaUrdf) + carried("right");
  EXPECT_EQ("fr3", detect("two_arms", both, {}, "left").name);
  EXPECT_EQ("panda", detect("two_arms", both, {}, "right").name);
}

TEST(RobotType, FollowsTheNameIfTheJointsAreAmbiguous) {
  for (const std::string& parts :
       {joints("arm", slowed(narrowed(kFr3Urdf))), joints("other", kFr3Urdf)}) {
    EXPECT_EQ("fr3", detect("fr3", parts).name);
    EXPECT_EQ("panda", detect("my_machine", parts).name);
    EXPECT_TRUE(contains(detect("my_machine", parts).why, "'my_machine'"));
    EXPECT_EQ("", detect("my_machine", parts, "fr3").warning);
  }
}

TEST(RobotType, ParameterOverridesTheJointsAndWarns) {
  const RobotType agreed = detect("my_machine", joints("arm", kFr3Urdf), "fr3");
  EXPECT_EQ("fr3", agreed.name);
  EXPECT_EQ("", agreed.warning);
  const RobotType contradicted = detect("fr3", joints("arm", kFr3Urdf), "panda");
  EXPECT_EQ("panda", contradicted.name);
  EXPECT_TRUE(contains(contradicted.warning, "looks like fr3: the positions"));
  EXPECT_TRUE(isRobotType("panda") && isRobotType("fr3"));
  EXPECT_FALSE(isRobotType("") || isRobotType("FR3") || isRobotType("ur5"));
}

std::string plugin(const std::string& name, const std::string& type,
                   const std::string& robot_namespace = "") {
  return "<gazebo><plugin name='" + name + "' filename='libgazebo_ros_control.so'><robotSimType>" +
         type + "</robotSimType><robotNamespace>" + robot_namespace +
         "</robotNamespace></plugin></gazebo>";
}

std::string robotWith(const std::string& content) {
  return "<robot name='r'><link name='l'/>" + content + "</robot>";
}

TEST(PluginElement, OfTheArmIsPreferredInItsNamespace) {
  const std::string device = plugin("lift", "gazebo_ros_control/DefaultRobotHWSim", "/arm/");
  const std::string arm = plugin("arm", "franka_gazebo/FrankaHWSim");
  for (const std::string& both : {device + arm, arm + device}) {
    EXPECT_EQ("arm", readPluginElement(robotWith(both), "arm").name);
  }
  EXPECT_EQ("lift", readPluginElement(robotWith(device), "arm").name);
  EXPECT_EQ("", readPluginElement(robotWith(""), "arm").hardware_type);
}

TEST(PluginElement, OfTwoNamespacesAreRefusedByName) {
  const std::string text = robotWith(plugin("lift", "gazebo_ros_control/DefaultRobotHWSim", "/up") +
                                     plugin("arm", "franka_gazebo/FrankaHWSim"));
  const std::string error = sentence([&] { readPluginElement(text, "/"); });
  EXPECT_TRUE(contains(error, "'lift'") && contains(error, "'arm'") && contains(error, "/up"))
      << error;
}

TEST(PluginElement, HasAllArmsOfFrankaHWSim) {
  const auto states = [](const std::string& arm) {
    return "<transmission name='" + arm + "_franka_state'><type>franka_hw/FrankaStateInterface" +
           "</type><joint name='" + arm + "_joint1'/><joint name='" + arm +
           "_joint2'/></transmission>";
  };
  const auto arms = [&](const std::string& content) {
    return readPluginElement(robotWith(content), "/").arms;
  };
  const std::string both = states("panda_1") + states("panda_2");
  const std::vector<std::string> names{"panda_1", "panda_2"};
  EXPECT_EQ(names, arms(both + plugin("arm", "franka_gazebo/FrankaHWSim")));
  EXPECT_EQ(names, arms(both));
  EXPECT_TRUE(arms(both + plugin("other", "gazebo_ros_control/DefaultRobotHWSim")).empty());
  EXPECT_TRUE(contains(sentence([&] { arms(both + states("panda_2")); }), "'panda_2'"));
}

}  // namespace
}  // namespace franka_sim_mujoco
