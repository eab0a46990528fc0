// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>

#include <list>
#include <set>
#include <string>

using namespace hardware_interface;

namespace {

const char* const kEffort = "hardware_interface::EffortJointInterface";
const char* const kPosition = "hardware_interface::PositionJointInterface";

ControllerInfo controller(const std::string& name, const std::set<std::string>& efforts,
                          const std::set<std::string>& positions = {}) {
  ControllerInfo info;
  info.name = name;
  info.type = "test/Controller";
  info.claimed_resources.emplace_back(kEffort, efforts);
  info.claimed_resources.emplace_back(kPosition, positions);
  return info;
}

bool conflict(const std::list<ControllerInfo>& controllers) {
  return RobotHW().checkForConflict(controllers);
}

}  // namespace

TEST(RobotHW, ControllersOfDifferentResourcesDoNotConflict) {
  EXPECT_FALSE(conflict({}));
  EXPECT_FALSE(conflict({controller("a", {})}));
  EXPECT_FALSE(conflict({controller("a", {"j1", "j2"}), controller("b", {"j3"}, {"j4"})}));
}

TEST(RobotHW, ResourceBelongsToOneControllerOnly) {
  EXPECT_TRUE(conflict({controller("a", {"j1", "j2"}), controller("b", {"j2"})}));
}

TEST(RobotHW, ConflictsAreIndependentOfTheInterface) {
  EXPECT_TRUE(conflict({controller("a", {"j1"}), controller("b", {}, {"j1"})}));
  EXPECT_TRUE(conflict({controller("itself", {"j1"}, {"j1"})}));
}

TEST(RobotHW, HasDefaultImplementations) {
  RobotHW robot;
  const std::list<ControllerInfo> none;
  EXPECT_TRUE(robot.prepareSwitch(none, none));
  EXPECT_EQ(RobotHW::SwitchState::DONE, robot.switchResult());
  EXPECT_EQ(RobotHW::SwitchState::DONE, robot.switchResult(controller("a", {})));
  robot.doSwitch(none, none);
  robot.read(ros::Time(1.0), ros::Duration(0.001));
  robot.write(ros::Time(1.0), ros::Duration(0.001));
}
