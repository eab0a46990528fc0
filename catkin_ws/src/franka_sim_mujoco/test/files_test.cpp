// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World files by name, files that packages export, and the file of physical parameters.

#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world_properties.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "resources.h"
#include "sentences.h"
#include "temporary_folder.h"

namespace franka_sim_mujoco {
namespace {

TEST(WorldFile, FindsWorldsByTheirNames) {
  namespace fs = std::filesystem;
  const franka_test::TemporaryFolder own;
  const fs::path& folder = own.path();
  for (const char* name : {"stone.xml", "elsewhere/beside.xml", "elsewhere/beside.sdf"}) {
    own.write(name, "<mujoco/>");
  }
  const std::vector<std::string> folders{folder.string()};
  const std::string stone = (folder / "stone.xml").string();
  EXPECT_EQ("", findWorldFile("", folders));
  EXPECT_EQ(stone, findWorldFile(stone, {}));
  EXPECT_EQ(stone, findWorldFile("stone", folders));
  EXPECT_EQ(stone, findWorldFile("worlds/stone.world", folders));
  EXPECT_EQ(stone, findWorldFile("/nowhere/world/stone.sdf", folders));
  const std::string sdf = (folder / "elsewhere/beside.sdf").string();
  EXPECT_EQ(sdf, findWorldFile(sdf, folders));
  EXPECT_EQ(sdf, findWorldFile("elsewhere/beside.sdf", folders));
  EXPECT_EQ((folder / "elsewhere/beside.xml").string(),
            findWorldFile((folder / "elsewhere/beside.world").string(), folders));
  const std::string text = sentence([&] { findWorldFile("/nowhere/moon.sdf", folders); });
  EXPECT_TRUE(contains(text, "/nowhere/moon.sdf") && contains(text, folder.string())) << text;
}

/// The only test in this program that searches packages: they are searched once.
TEST(Resources, AreFoundInFoldersThatPackagesExport) {
  namespace fs = std::filesystem;
  const franka_test::TemporaryFolder folder;
  const fs::path package = folder.path() / "pebbles";
  folder.write("pebbles/package.xml",
               "<package format='2'><name>pebbles</name><version>1.0.0</version>"
               "<description>d</description><maintainer email='a@b.org'>a</maintainer>"
               "<license>none</license><exec_depend>gazebo_ros</exec_depend><export>"
               "<gazebo_ros gazebo_model_path='${prefix}/my_models'/>"
               "<gazebo_ros gazebo_media_path='${prefix}/my_worlds'/>"
               "<gazebo_ros plugin_path='${prefix}/lib'/></export></package>");
  const std::string model = folder.write(
      "pebbles/my_models/pebble/model.sdf",
      "<sdf version='1.6'><model name='pebble'><link name='link'><collision name='c'><geometry>"
      "<sphere><radius>0.02</radius></sphere></geometry></collision></link></model></sdf>");
  folder.write("pebbles/my_models/pebble/model.config",
               "<model><name>pebble</name><version>1.0</version>"
               "<sdf version='1.6'>model.sdf</sdf></model>");
  const std::string world =
      folder.write("pebbles/my_worlds/beach.sdf",
                   "<sdf version='1.6'><world name='beach'>"
                   "<include><uri>model://pebble</uri><pose>0 0 1 0 0 0</pose></include>"
                   "<include><uri>model://stone</uri><pose>1 0 1 0 0 0</pose></include>"
                   "</world></sdf>");
  const char* before = std::getenv("ROS_PACKAGE_PATH");
  ASSERT_NE(before, nullptr);
  setenv("ROS_PACKAGE_PATH", (package.string() + ":" + before).c_str(), 1);

  EXPECT_EQ(resolveUri("model://pebble/model.sdf"), model);
  EXPECT_TRUE(fs::is_regular_file(resolveUri("model://stone/model.sdf")));
  EXPECT_EQ(resolveUri("model://no_such_thing/model.sdf"), "");
  EXPECT_EQ(resolveUri("package://pebbles/package.xml"), (package / "package.xml").string());
  const auto plugins = gazeboPluginFolders();
  EXPECT_EQ(std::count(plugins.begin(), plugins.end(), (package / "lib").string()), 1);
  EXPECT_EQ(findWorldFile("beach.sdf", gazeboResourceFolders()), world);

  franka_sim::World beach(world, resolveUri);
  EXPECT_EQ(bodyPose(beach, "pebble").position[2], 1.0);
  EXPECT_EQ(bodyPose(beach, "stone").position[0], 1.0);
}

class PhysicsFile : public testing::Test {
 protected:
  franka_sim::RobotPhysics read(const std::string& text, const std::string& realism = "ideal") {
    return franka_sim::readRobotPhysics(folder_.write(kFile, text), "panda",
                                        franka_sim::readRealism(realism, "ideal"));
  }
  static constexpr char kFile[] = "physics.yaml";
  franka_test::TemporaryFolder folder_;
};

TEST_F(PhysicsFile, TakesTheRobotsSectionAndItsParts) {
  const std::string text =
      "panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, 7], joint_stops: {lower: [-1, -1, -1, -1, -1, -1, "
      "-1], upper: [1, 1, 1, 1, 1, 1, 2]}, motors: {inertia: [.1, .2, .3, .4, .5, .6, .7]}, "
      "friction: {viscous: [1, 2, 3, 4, 5, 6, 7]}}\n";
  const franka_sim::RobotPhysics ideal = read(text);
  EXPECT_EQ(7.0, ideal.joints.rotor_inertia[6]);
  EXPECT_FALSE(ideal.joints.friction[6].acts());
  ASSERT_TRUE(ideal.joints.stops);
  EXPECT_EQ(2.0, ideal.joints.stops->upper[6]);
  EXPECT_EQ(0.7, read(text, "motors=on").joints.rotor_inertia[6]);
  EXPECT_EQ(7.0, read(text, "friction=on").joints.friction[6].viscous);
}

TEST_F(PhysicsFile, ReportsErrorsWithTheirCause) {
  const auto complaint = [this](const std::string& text, const std::string& realism = "ideal") {
    return sentence([&] { read(text, realism); });
  };
  EXPECT_TRUE(contains(complaint("fr3: {}"), "no section 'panda'"));
  EXPECT_TRUE(contains(complaint("panda: {rotor_inertia: [1, 2]}"),
                       "panda/rotor_inertia must be a list of 7"));
  EXPECT_TRUE(
      contains(complaint("panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, x]}"), "finite numbers"));
  EXPECT_TRUE(
      contains(complaint("panda: {rotor_inertia: [1, 2, 3, 4, 5, 6, .nan]}"), "finite numbers"));
  EXPECT_TRUE(contains(complaint("panda: {}", "motors=on"), "no section 'motors'"));
  EXPECT_TRUE(contains(complaint("panda: {friction: {vicous: 1}}", "friction=on"), "'vicous'"));
  EXPECT_TRUE(contains(complaint("panda: {gripper: {start: -1}}", "gripper=on"), "from 0 to 10"));
  EXPECT_TRUE(
      contains(complaint("panda: {bandwidth: {tau_ext_hat_filtered: [0, 1, 1, 1, 1, 1, 1]}}",
                         "bandwidth=on"),
               "must be positive"));
  EXPECT_TRUE(contains(complaint("panda: ["), folder_ / kFile));
  EXPECT_TRUE(contains(sentence([] { franka_sim::readRobotPhysics("/nowhere.yaml", "panda", {}); }),
                       "/nowhere.yaml"));
}

}  // namespace
}  // namespace franka_sim_mujoco
