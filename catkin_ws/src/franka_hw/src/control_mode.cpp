// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/control_mode.h>

#include <array>
#include <utility>

namespace franka_hw {

std::ostream& operator<<(std::ostream& stream, ControlMode mode) {
  constexpr std::array<std::pair<ControlMode, const char*>, 5> kNames{{
      {ControlMode::JointTorque, "joint_torque"},
      {ControlMode::JointPosition, "joint_position"},
      {ControlMode::JointVelocity, "joint_velocity"},
      {ControlMode::CartesianVelocity, "cartesian_velocity"},
      {ControlMode::CartesianPose, "cartesian_pose"},
  }};
  if (mode == ControlMode::None) {
    return stream << "<none>";
  }
  const char* separator = "";
  for (const auto& [bit, name] : kNames) {
    if ((mode & bit) != ControlMode::None) {
      stream << separator << name;
      separator = ", ";
    }
  }
  return stream;
}

}  // namespace franka_hw
