// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// User programs, built against the public headers alone and run unchanged, for interfaces that
// the programs in examples/cpp do not use. Only the port in the address shows that the robot is a
// fake.
#include <cstdlib>

#include "random_state.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

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

/// Runs a program. @returns its exit status
int run(const std::string& program, FakeRobot& fake) {
  const std::string urdf = descriptionOfFr3();
  fake.script([&urdf](FakeRobot::Script& s) { s.urdf.assign(urdf.begin(), urdf.end()); });
  const std::string command = std::string(LIBFRANKA_TEST_PROGRAMS) + "/libfranka_program_" +
                              program + " " + fake.address() + " > /dev/null";
  return WEXITSTATUS(std::system(command.c_str()));
}

TEST(Programs, ApplyVelocityLimitsThatDependOnThePosition) {
  FakeRobot fake(10);
  EXPECT_EQ(0, run("velocity_limits", fake));
  EXPECT_EQ(1, fake.count(Command::kMove));
  EXPECT_EQ(0, fake.count(Command::kStopMove));
  EXPECT_EQ(franka_core::RobotMode::kIdle, fake.state().robot_mode);
}

TEST(Programs, DetectThatAnArmIsNotAMobileBase) {
  FakeRobot fake(10);
  EXPECT_EQ(1, run("mobile_base", fake));
}

}  // namespace
}  // namespace franka_test
