// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/robot_mismatch.h>
#include <gtest/gtest.h>
#include <source_file.h>

#include <cmath>
#include <optional>

namespace {

using franka_hw::robotMismatch;

constexpr unsigned kPanda = 5, kFr3 = 10;  // protocols

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

/// The description of one of the two robots: its joints are named after the arm, and one text is
/// replaced.
urdf::Model describe(const std::string& robot, const std::string& arm_id,
                     const std::string& from = "@", const std::string& to = "") {
  std::string urdf = franka_test::readSource("libfranka/test/data/" + robot + "_hand.urdf");
  replaceAll(urdf, robot + "_", arm_id + "_");
  replaceAll(urdf, from, to);
  urdf::Model model;
  EXPECT_TRUE(model.initString(urdf));
  return model;
}

std::array<std::string, 7> joints(const std::string& arm_id) {
  std::array<std::string, 7> names;
  for (std::size_t i = 0; i < names.size(); i++) {
    names[i] = arm_id + "_joint" + std::to_string(i + 1);
  }
  return names;
}

std::string mismatch(const urdf::Model& description, const std::string& arm_id, unsigned protocol) {
  return robotMismatch(description, arm_id, joints(arm_id), protocol);
}

void expectWords(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(std::string::npos, text.find(word)) << "'" << word << "' is not in: " << text;
  }
}

TEST(RobotMismatch, IsNoneWhereRobotDescriptionAndNamesAgree) {
  for (const std::string arm_id : {"panda", "fr3", "left", "my_joint_arm"}) {
    for (const unsigned protocol : {3u, 4u, 5u}) {
      EXPECT_EQ("", mismatch(describe("panda", arm_id), arm_id, protocol)) << arm_id;
    }
    for (const unsigned protocol : {6u, 7u, 9u, 10u}) {
      EXPECT_EQ("", mismatch(describe("fr3", arm_id), arm_id, protocol)) << arm_id;
    }
  }
}

TEST(RobotMismatch, ReportsAnFr3WithThePandasDescription) {
  expectWords(mismatch(describe("panda", "left"), "left", kFr3),
              {"the robot is an FR3 (protocol 10)", "robot_description is a Panda's", "left_joint6",
               "-0.0175 to 3.7525 rad", "0.4398 to 4.6216 rad", "robot:=fr3"});
}

TEST(RobotMismatch, ReportsAPandaWithTheFr3sDescription) {
  expectWords(mismatch(describe("fr3", "fr3"), "fr3", kPanda),
              {"the robot is a Panda (protocol 5)", "robot_description is an FR3's", "fr3_joint6",
               "0.8521 to 4.2094 rad", "-0.0175 to 3.7525 rad", "robot:=panda"});
}

TEST(RobotMismatch, ReportsARangeThatNeitherRobotHas) {
  const std::string limit = R"(lower="-2.8973" upper="2.8973")";
  const urdf::Model wide = describe("panda", "panda", limit, R"(lower="-6.0" upper="6.0")");
  for (const unsigned protocol : {kPanda, kFr3}) {
    expectWords(mismatch(wide, "panda", protocol), {"another robot's", "panda_joint1", "-6 to 6"});
  }
}

TEST(RobotMismatch, AcceptsNarrowerRanges) {
  const std::string limit = R"(lower="-0.0175" upper="3.7525")";
  const urdf::Model narrow = describe("panda", "panda", limit, R"(lower="1.0" upper="2.0")");
  EXPECT_EQ("", mismatch(narrow, "panda", kPanda));
  EXPECT_EQ("", mismatch(narrow, "panda", kFr3)) << "all of it an FR3 can reach, too";
}

TEST(RobotMismatch, ReportsAnArmThatIsNotInTheDescription) {
  expectWords(mismatch(describe("panda", "panda"), "fr3", kPanda),
              {"'fr3' (arm_id)", "no joint 'fr3_joint1'", "it describes 'panda'"});
  urdf::Model none;
  ASSERT_TRUE(none.initString(R"(<robot name="none"><link name="base"/></robot>)"));
  expectWords(mismatch(none, "panda", kPanda), {"no joint 'panda_joint1'", "it describes no arm"});
}

TEST(RobotMismatch, ReportsJointsThatAreNamedAfterAnotherArm) {
  const urdf::Model description = describe("panda", "panda");
  expectWords(robotMismatch(description, "fr3", joints("panda"), kPanda),
              {"arm_id is 'fr3'", "joint_names holds 'panda_joint1'", "fr3_joint1 to fr3_joint7"});
}

TEST(EndEffectorMismatch, NamesTheDifferenceBeyondRounding) {
  std::array<double, 16> frame{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.1204, 1};
  const auto described = frame;
  EXPECT_EQ("", franka_hw::endEffectorMismatch(std::nullopt, frame, "left"));
  frame[12] = 0.00009;
  EXPECT_EQ("", franka_hw::endEffectorMismatch(described, frame, "left"));
  frame[14] = 0.1034;
  expectWords(franka_hw::endEffectorMismatch(described, frame, "left"),
              {"17 mm", "left_hand_tcp", "0.1204 1"});
  const std::array<double, 16> exact{M_SQRT1_2, -M_SQRT1_2, 0, 0, M_SQRT1_2, M_SQRT1_2, 0, 0,
                                     0,         0,          1, 0, 0,         0,         0, 1};
  auto rounded = exact;  // as the original's default and as typed in Desk
  for (double& value : rounded) {
    value = std::round(1e4 * value) / 1e4;
  }
  EXPECT_EQ("", franka_hw::endEffectorMismatch(exact, rounded, "left"));
  frame = described;
  frame[0] = frame[5] = std::cos(0.1);  // turned by 0.1 rad about z
  frame[1] = std::sin(0.1);
  frame[4] = -std::sin(0.1);
  expectWords(franka_hw::endEffectorMismatch(described, frame, "left"), {"0 mm and 0.1 rad"});
  frame = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0.1204, 1};
  expectWords(franka_hw::endEffectorMismatch(described, frame, "left"), {"and 3.14 rad"});
}

}  // namespace
