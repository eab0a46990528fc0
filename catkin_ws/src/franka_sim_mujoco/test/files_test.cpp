// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World files by name, and files that packages export.

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
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

}  // namespace
}  // namespace franka_sim_mujoco
