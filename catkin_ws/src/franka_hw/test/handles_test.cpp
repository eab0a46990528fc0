// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <type_traits>

namespace franka_hw {
namespace {

using Names = std::set<std::string>;

static_assert(!std::is_default_constructible_v<FrankaStateHandle>);
static_assert(!std::is_default_constructible_v<FrankaCartesianPoseHandle>);
static_assert(!std::is_default_constructible_v<FrankaCartesianVelocityHandle>);

TEST(CartesianPoseInterface, CommandsAPoseWithAndWithoutElbow) {
  franka::RobotState state;
  std::array<double, 16> command{};
  std::array<double, 2> elbow{};
  FrankaPoseCartesianInterface poses;
  poses.registerHandle(
      FrankaCartesianPoseHandle(FrankaStateHandle("panda_robot", state), command, elbow));
  EXPECT_TRUE(poses.getClaims().empty());

  FrankaCartesianPoseHandle handle = poses.getHandle("panda_robot");
  EXPECT_EQ(Names{"panda_robot"}, poses.getClaims());
  const std::array<double, 16> pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.3, 0.1, 0.5, 1};
  handle.setCommand(pose, {{0.25, -1.0}});
  EXPECT_EQ(pose, command);
  EXPECT_EQ((std::array<double, 2>{0.25, -1.0}), elbow);
  EXPECT_EQ(pose, handle.getCommand());

  const std::array<double, 16> next{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.4, 0.1, 0.5, 1};
  handle.setCommand(next);
  EXPECT_EQ(next, command);
  EXPECT_EQ((std::array<double, 2>{0.0, 0.0}), elbow);
  EXPECT_EQ(&state, &handle.getRobotState());
}

TEST(CartesianVelocityInterface, CommandsAVelocityWithAndWithoutElbow) {
  franka::RobotState state;
  std::array<double, 6> command{};
  std::array<double, 2> elbow{};
  FrankaVelocityCartesianInterface velocities;
  velocities.registerHandle(
      FrankaCartesianVelocityHandle(FrankaStateHandle("fr3_robot", state), command, elbow));

  FrankaCartesianVelocityHandle handle = velocities.getHandle("fr3_robot");
  EXPECT_EQ(Names{"fr3_robot"}, velocities.getClaims());
  std::array<double, 6> velocity{1, 2, 3, 4, 5, 6};
  handle.setCommand(velocity, {{0.5, 1.0}});
  EXPECT_EQ(velocity, handle.getCommand());
  EXPECT_EQ((std::array<double, 2>{0.5, 1.0}), elbow);
  handle.setCommand({{6, 5, 4, 3, 2, 1}});
  EXPECT_EQ((std::array<double, 6>{6, 5, 4, 3, 2, 1}), command);
  EXPECT_EQ((std::array<double, 2>{0.0, 0.0}), elbow);
}

}  // namespace
}  // namespace franka_hw
