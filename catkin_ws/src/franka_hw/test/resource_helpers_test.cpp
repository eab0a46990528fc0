// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/resource_helpers.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <list>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace franka_hw {
namespace {

using hardware_interface::ControllerInfo;
using hardware_interface::InterfaceResources;

const char* const kJP = "hardware_interface::PositionJointInterface";
const char* const kJV = "hardware_interface::VelocityJointInterface";
const char* const kJT = "hardware_interface::EffortJointInterface";
const char* const kCP = "franka_hw::FrankaPoseCartesianInterface";
const char* const kCV = "franka_hw::FrankaVelocityCartesianInterface";

std::set<std::string> joints(const std::string& arm_id, int first, int last) {
  std::set<std::string> names;
  for (int i = first; i <= last; ++i) {
    names.insert(arm_id + "_joint" + std::to_string(i));
  }
  return names;
}

/// A complete claim of one interface: seven joints, or the robot.
InterfaceResources whole(const std::string& interface, const std::string& arm_id = "panda") {
  const bool cartesian = interface == kCP || interface == kCV;
  return {interface, cartesian ? std::set<std::string>{arm_id + "_robot"} : joints(arm_id, 1, 7)};
}

ControllerInfo controller(const std::string& name, std::vector<InterfaceResources> claims) {
  ControllerInfo info;
  info.name = name;
  info.type = name + "_type";
  info.claimed_resources = std::move(claims);
  return info;
}

/// The result of both kinds of hardware for a set of controllers, and its control mode.
struct Verdict {
  bool franka_hw_refuses;
  bool combinable_hw_refuses;
  ControlMode mode;
};

Verdict judge(const std::list<ControllerInfo>& controllers, const std::string& arm_id = "panda") {
  ResourceWithClaimsMap resources = getResourceMap(controllers);
  if (hasConflictingMultiClaim(resources)) {
    return {true, true, ControlMode::None};
  }
  ArmClaimedMap arms;
  if (!getArmClaimedMap(resources, arms)) {
    return {true, true, ControlMode::None};
  }
  const bool partial = partiallyClaimsArmJoints(arms, arm_id);
  return {partial || hasConflictingJointAndCartesianClaim(arms, arm_id),
          partial || hasTrajectoryClaim(arms, arm_id), getControlMode(arm_id, arms)};
}

/// One controller that claims every interface of the list completely.
Verdict judgeOne(std::initializer_list<const char*> interfaces) {
  std::vector<InterfaceResources> claims;
  for (const char* interface : interfaces) {
    claims.push_back(whole(interface));
  }
  return judge({controller("one", claims)});
}

void expectVerdict(const Verdict& expected, const Verdict& actual, const std::string& what) {
  EXPECT_EQ(expected.franka_hw_refuses, actual.franka_hw_refuses) << what;
  EXPECT_EQ(expected.combinable_hw_refuses, actual.combinable_hw_refuses) << what;
  EXPECT_EQ(expected.mode, actual.mode) << what;
}

TEST(FindArmId, TakesTheTextBeforeTheLastMarker) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"panda_joint1", "panda"},
      {"panda_robot", "panda"},
      {"panda_finger_joint1", "panda_finger"},
      {"my_arm_2_joint7", "my_arm_2"},
      {"a_joint_b_joint3", "a_joint_b"},
      {"a_robot_joint3", "a_robot"},
      {"a_joint_robot", "a"},  // joints are searched for first
      {"_joint_robot", "_joint"},
  };
  for (const auto& [resource, expected] : cases) {
    std::string arm_id;
    EXPECT_TRUE(findArmIdInResourceId(resource, &arm_id)) << resource;
    EXPECT_EQ(expected, arm_id) << resource;
  }
}

TEST(FindArmId, RefusesNamesWithoutAnArm) {
  for (const char* resource : {"joint1", "_joint1", "_robot", "robot", "panda", "", "panda_joi"}) {
    std::string arm_id = "untouched";
    EXPECT_FALSE(findArmIdInResourceId(resource, &arm_id)) << resource;
    EXPECT_EQ("untouched", arm_id) << resource;
  }
}

TEST(GetResourceMap, ListsEveryClaimOnEachResource) {
  const ResourceWithClaimsMap map = getResourceMap(
      {controller("a", {{kJT, {"panda_joint1", "panda_joint2"}}, {kCP, {"panda_robot"}}}),
       controller("b", {{kJP, {"panda_joint1"}}, {"franka_hw::FrankaStateInterface", {}}})});
  ASSERT_EQ(3U, map.size());
  using Claims = std::vector<std::vector<std::string>>;
  EXPECT_EQ((Claims{{"a", "a_type", kJT}, {"b", "b_type", kJP}}), map.at("panda_joint1"));
  EXPECT_EQ((Claims{{"a", "a_type", kJT}}), map.at("panda_joint2"));
  EXPECT_EQ((Claims{{"a", "a_type", kCP}}), map.at("panda_robot"));
}

TEST(GetArmClaimedMap, CountsPerArmAndInterface) {
  ResourceWithClaimsMap resources = getResourceMap(
      {controller("a", {whole(kJT, "left"), whole(kCV, "left"), {kJV, joints("right", 1, 3)}}),
       controller("b", {whole(kJP, "right"), whole(kCP, "right")})});
  ArmClaimedMap arms;
  ASSERT_TRUE(getArmClaimedMap(resources, arms));
  ASSERT_EQ(2U, arms.size());
  EXPECT_EQ(7, arms["left"].joint_torque_claims);
  EXPECT_EQ(1, arms["left"].cartesian_velocity_claims);
  EXPECT_EQ(0, arms["left"].joint_position_claims);
  EXPECT_EQ(0, arms["left"].joint_velocity_claims);
  EXPECT_EQ(0, arms["left"].cartesian_pose_claims);
  EXPECT_EQ(3, arms["right"].joint_velocity_claims);
  EXPECT_EQ(7, arms["right"].joint_position_claims);
  EXPECT_EQ(1, arms["right"].cartesian_pose_claims);
}

TEST(ClaimRules, AllowNothingAndReadOnlyControllers) {
  expectVerdict({false, false, ControlMode::None}, judge({}), "no controller");
  expectVerdict({false, false, ControlMode::None},
                judge({controller("reader", {{"franka_hw::FrankaStateInterface", {}},
                                             {"hardware_interface::JointStateInterface", {}}})}),
                "reader");
}

TEST(ClaimRules, AllowEachInterfaceAloneAndWithTorques) {
  using Mode = ControlMode;
  const std::vector<std::pair<const char*, Mode>> generators{{kJP, Mode::JointPosition},
                                                             {kJV, Mode::JointVelocity},
                                                             {kCP, Mode::CartesianPose},
                                                             {kCV, Mode::CartesianVelocity}};
  expectVerdict({false, false, Mode::JointTorque}, judgeOne({kJT}), "JT");
  for (const auto& [interface, mode] : generators) {
    expectVerdict({false, true, mode}, judgeOne({interface}), interface);
    expectVerdict({false, true, mode | Mode::JointTorque}, judgeOne({kJT, interface}), interface);
    expectVerdict({false, true, mode | Mode::JointTorque},
                  judge({controller("t", {whole(kJT)}), controller("g", {whole(interface)})}),
                  interface);
  }
}

TEST(ClaimRules, RefuseOneInterfaceTwice) {
  for (const char* interface : {kJP, kJV, kJT, kCP, kCV}) {
    expectVerdict({true, true, ControlMode::None}, judgeOne({interface, interface}), interface);
    expectVerdict({true, true, ControlMode::None},
                  judge({controller("a", {whole(interface)}), controller("b", {whole(interface)})}),
                  interface);
  }
}

TEST(ClaimRules, RefuseTwoMotionGenerators) {
  const Verdict refused{true, true, ControlMode::None};
  expectVerdict(refused, judgeOne({kJP, kJV}), "JP+JV");
  expectVerdict(refused, judgeOne({kCP, kCV}), "CP+CV");
  for (const char* joint : {kJP, kJV}) {
    for (const char* cartesian : {kCP, kCV}) {
      const std::string what = std::string(joint) + "+" + cartesian;
      expectVerdict(refused, judgeOne({joint, cartesian}), what);
      expectVerdict(refused, judgeOne({kJT, joint, cartesian}), what + " with torques");
    }
  }
}

TEST(ClaimRules, RefuseThreeClaimsOnOneResource) {
  const Verdict refused{true, true, ControlMode::None};
  expectVerdict(refused, judgeOne({kJT, kJP, kJV}), "JT+JP+JV");
  expectVerdict(refused, judgeOne({kJT, kJT, kJP}), "JT+JT+JP");
}

TEST(ClaimRules, RefuseAnythingButSevenJoints) {
  const Verdict refused{true, true, ControlMode::None};
  for (const char* interface : {kJP, kJV, kJT}) {
    for (int last : {1, 6, 8}) {
      const Verdict verdict = judge({controller("some", {{interface, joints("panda", 1, last)}})});
      EXPECT_TRUE(verdict.franka_hw_refuses) << interface << last;
      EXPECT_TRUE(verdict.combinable_hw_refuses) << interface << last;
    }
  }
  expectVerdict(
      refused,
      judge({controller("split", {{kJP, joints("panda", 1, 3)}, {kJV, joints("panda", 4, 7)}})}),
      "positions on three joints, velocities on four");
}

TEST(ClaimRules, RefuseUnknownInterfacesAndNames) {
  const Verdict refused{true, true, ControlMode::None};
  expectVerdict(refused, judge({controller("x", {{"some::Interface", {"panda_joint1"}}})}),
                "unknown interface");
  expectVerdict(refused, judge({controller("x", {{kJT, {"wheel"}}})}), "unknown name");
}

TEST(ClaimRules, JudgeTheOwnArmOnly) {
  expectVerdict({false, false, ControlMode::JointTorque},
                judge({controller("own", {whole(kJT)}),
                       controller("other", {whole(kJP, "left"), whole(kCP, "right")})}),
                "other arms move");
  expectVerdict({false, false, ControlMode::None},
                judge({controller("other", {{kJP, joints("left", 1, 2)}})}),
                "another arm is claimed in part");
}

}  // namespace
}  // namespace franka_hw
