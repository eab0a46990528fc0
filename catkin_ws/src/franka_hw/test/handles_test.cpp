// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <gtest/gtest.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/robot_hw.h>

#include <set>
#include <string>
#include <type_traits>

namespace franka_hw {
namespace {

using Names = std::set<std::string>;

static_assert(!std::is_default_constructible_v<FrankaStateHandle>);
static_assert(!std::is_default_constructible_v<FrankaCartesianPoseHandle>);
static_assert(!std::is_default_constructible_v<FrankaCartesianVelocityHandle>);

TEST(FrankaStateInterface, ShowsTheLiveStateAndClaimsNothing) {
  franka::RobotState state;
  FrankaStateInterface states;
  states.registerHandle(FrankaStateHandle("panda_robot", state));

  const FrankaStateHandle handle = states.getHandle("panda_robot");
  EXPECT_EQ("panda_robot", handle.getName());
  EXPECT_EQ(&state, &handle.getRobotState());
  state.q[3] = -1.25;
  EXPECT_EQ(-1.25, handle.getRobotState().q[3]);
  EXPECT_TRUE(states.getClaims().empty());
}

TEST(FrankaStateInterface, MergesTheArmsOfSeveralRobots) {
  franka::RobotState left_state;
  franka::RobotState right_state;
  FrankaStateInterface left;
  FrankaStateInterface right;
  left.registerHandle(FrankaStateHandle("left_robot", left_state));
  right.registerHandle(FrankaStateHandle("right_robot", right_state));
  hardware_interface::RobotHW left_hw;
  hardware_interface::RobotHW right_hw;
  left_hw.registerInterface(&left);
  right_hw.registerInterface(&right);
  hardware_interface::RobotHW both;
  both.registerInterfaceManager(&left_hw);
  both.registerInterfaceManager(&right_hw);

  FrankaStateInterface* merged = both.get<FrankaStateInterface>();
  ASSERT_NE(nullptr, merged);
  EXPECT_EQ(&left_state, &merged->getHandle("left_robot").getRobotState());
  EXPECT_EQ(&right_state, &merged->getHandle("right_robot").getRobotState());
}

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

TEST(Interfaces, HaveTheNamesThatClaimsAreComparedWith) {
  using hardware_interface::internal::demangledTypeName;
  EXPECT_EQ("franka_hw::FrankaStateInterface", demangledTypeName<FrankaStateInterface>());
  EXPECT_EQ("franka_hw::FrankaPoseCartesianInterface",
            demangledTypeName<FrankaPoseCartesianInterface>());
  EXPECT_EQ("franka_hw::FrankaVelocityCartesianInterface",
            demangledTypeName<FrankaVelocityCartesianInterface>());
}

TEST(Interfaces, NameTheMissingResource) {
  FrankaStateInterface states;
  try {
    states.getHandle("panda_robot");
    FAIL() << "a handle was returned that is not registered";
  } catch (const hardware_interface::HardwareInterfaceException& error) {
    EXPECT_STREQ("Could not find resource 'panda_robot' in 'franka_hw::FrankaStateInterface'.",
                 error.what());
  }
}

}  // namespace
}  // namespace franka_hw
