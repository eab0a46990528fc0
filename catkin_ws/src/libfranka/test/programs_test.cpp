// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Programs as users write them, built against the public headers alone and run as they are. An
// address with a port is all that tells them that the robot is none.
#include <cstdlib>

#include "random_state.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

class Programs : public ::testing::TestWithParam<const char*> {};

TEST_P(Programs, RunUnchanged) {
  for (std::uint16_t version : {std::uint16_t{5}, std::uint16_t{8}, std::uint16_t{10}}) {
    const std::string program = GetParam();
    // The Panda gives its model as a library, which this robot has none of.
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

}  // namespace
}  // namespace franka_test
