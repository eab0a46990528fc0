// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/control_mode.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace franka_hw {
namespace {

std::string printed(ControlMode mode) {
  std::ostringstream stream;
  stream << mode;
  return stream.str();
}

TEST(ControlMode, HasOneBitPerKindOfCommand) {
  EXPECT_EQ(0, static_cast<int>(ControlMode::None));
  EXPECT_EQ(1, static_cast<int>(ControlMode::JointTorque));
  EXPECT_EQ(2, static_cast<int>(ControlMode::JointPosition));
  EXPECT_EQ(4, static_cast<int>(ControlMode::JointVelocity));
  EXPECT_EQ(8, static_cast<int>(ControlMode::CartesianVelocity));
  EXPECT_EQ(16, static_cast<int>(ControlMode::CartesianPose));
}

TEST(ControlMode, CombinesAtCompileTime) {
  constexpr ControlMode kBoth = ControlMode::JointTorque | ControlMode::CartesianPose;
  static_assert((kBoth & ControlMode::JointTorque) == ControlMode::JointTorque);
  static_assert((kBoth ^ ControlMode::JointTorque) == ControlMode::CartesianPose);
  static_assert((kBoth & ~ControlMode::JointTorque) == ControlMode::CartesianPose);

  ControlMode mode = ControlMode::JointVelocity;
  mode |= ControlMode::JointTorque;
  EXPECT_EQ(ControlMode::JointVelocity | ControlMode::JointTorque, mode);
  mode &= ~ControlMode::JointVelocity;
  EXPECT_EQ(ControlMode::JointTorque, mode);
}

TEST(ControlMode, PrintsNamesInFixedOrder) {
  EXPECT_EQ("<none>", printed(ControlMode::None));
  EXPECT_EQ("joint_torque", printed(ControlMode::JointTorque));
  EXPECT_EQ("joint_position", printed(ControlMode::JointPosition));
  EXPECT_EQ("joint_velocity", printed(ControlMode::JointVelocity));
  EXPECT_EQ("cartesian_velocity", printed(ControlMode::CartesianVelocity));
  EXPECT_EQ("cartesian_pose", printed(ControlMode::CartesianPose));
  EXPECT_EQ(
      "joint_torque, joint_position, joint_velocity, cartesian_velocity, cartesian_pose",
      printed(ControlMode::CartesianPose | ControlMode::CartesianVelocity |
              ControlMode::JointVelocity | ControlMode::JointPosition | ControlMode::JointTorque));
}

}  // namespace
}  // namespace franka_hw
