// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Typical user programs, built against the public headers alone and run unchanged. Only the port in
// the address shows that the robot is a fake.
#include <franka_core/fci/gripper_codec.h>

#include <cstdlib>

#include "fake_gripper.h"
#include "random_state.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

class Programs : public ::testing::TestWithParam<const char*> {};

TEST_P(Programs, RunUnchanged) {
  for (std::uint16_t version : {std::uint16_t{5}, std::uint16_t{8}, std::uint16_t{10}}) {
    const std::string program = GetParam();
    // The Panda sends its model as a library, which this robot does not have.
    if (version == 5 && program == "impedance_with_motion") {
      continue;
    }
    FakeRobot fake(version);
    const std::string urdf = readData("fr3_hand.urdf");
    fake.script([&urdf](FakeRobot::Script& s) { s.urdf.assign(urdf.begin(), urdf.end()); });
    const std::string command = std::string(LIBFRANKA_TEST_PROGRAMS) + "/libfranka_program_" +
                                program + " " + fake.address() + " > /dev/null";
    EXPECT_EQ(0, std::system(command.c_str())) << program << " on version " << version;
    EXPECT_GE(fake.count(Command::kMove), 1);
    EXPECT_EQ(0, fake.count(Command::kStopMove));
    EXPECT_EQ(franka_core::RobotMode::kIdle, fake.state().robot_mode);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Programs,
                         ::testing::Values("joint_positions", "velocities_and_pose",
                                           "impedance_with_motion", "active_control"),
                         [](const auto& info) { return std::string(info.param); });

/// The arm of the FR3 with its robot's velocity limits.
std::string descriptionOfFr3() {
  std::string urdf = readData("fr3_hand.urdf");
  const std::string limits =
      "<position_based_velocity_limits velocity_offset=\"0.3\" deceleration_limit=\"6\"/>";
  std::size_t at = 0;
  while ((at = urdf.find("</joint>", at)) != std::string::npos) {
    urdf.insert(at, limits);
    at += limits.size() + 1;
  }
  return urdf;
}

/// Runs programs for interfaces added in libfranka 0.18 to 0.21. @returns the exit status
int runNewest(const std::string& program, FakeRobot& fake) {
  const std::string urdf = descriptionOfFr3();
  fake.script([&urdf](FakeRobot::Script& s) { s.urdf.assign(urdf.begin(), urdf.end()); });
  const std::string command = std::string(LIBFRANKA_TEST_PROGRAMS) + "/libfranka_program_" +
                              program + " " + fake.address() + " > /dev/null";
  return WEXITSTATUS(std::system(command.c_str()));
}

TEST(NewestPrograms, ReachAsynchronousTargetsAndLogThem) {
  FakeRobot fake(10);
  EXPECT_EQ(0, runNewest("asynchronous_targets", fake));
  EXPECT_EQ(1, fake.count(Command::kMove));
  FakeRobot without(9);
  EXPECT_EQ(1, runNewest("asynchronous_targets", without));
}

TEST(NewestPrograms, ApplyVelocityLimitsThatDependOnThePosition) {
  FakeRobot fake(10);
  EXPECT_EQ(0, runNewest("velocity_limits", fake));
  EXPECT_EQ(franka_core::RobotMode::kIdle, fake.state().robot_mode);
}

TEST(NewestPrograms, DetectThatAnArmIsNotAMobileBase) {
  FakeRobot fake(10);
  EXPECT_EQ(1, runNewest("mobile_base", fake));
}

/// Runs the program for the hand. @returns its exit status
int graspAndLetGo(const FakeGripper& fake, const std::string& homing, const std::string& width) {
  const std::string command = std::string(LIBFRANKA_TEST_PROGRAMS) + "/libfranka_program_gripper " +
                              fake.address() + " " + homing + " " + width + " > /dev/null 2>&1";
  return WEXITSTATUS(std::system(command.c_str()));
}

TEST(HandPrograms, RunUnchanged) {
  namespace hand = franka_core::fci::gripper;
  FakeGripper fake(3);
  const auto show = [&fake](bool is_grasped) {
    hand::State state;
    state.width = 0.03;
    state.max_width = 0.08;
    state.is_grasped = is_grasped;
    hand::StateBuffer buffer;
    hand::encodeState(state, buffer);
    fake.show({buffer.begin(), buffer.end()});
  };
  show(true);
  EXPECT_EQ(0, graspAndLetGo(fake, "1", "0.03"));
  std::vector<unsigned> commands;
  for (const FakeGripper::Bytes& request : fake.requests()) {
    commands.push_back(request[0]);
  }
  // Homing, move, grasp, stop.
  EXPECT_EQ((std::vector<unsigned>{1, 3, 2, 4}), commands);
  EXPECT_EQ(1, graspAndLetGo(fake, "0", "0.09"));
  EXPECT_EQ(5u, fake.requests().size() + 1);
}

}  // namespace
}  // namespace franka_test
