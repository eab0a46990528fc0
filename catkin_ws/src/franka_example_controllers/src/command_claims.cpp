// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/command_claims.h>
#include <franka_hw/resource_helpers.h>

#include <algorithm>

namespace franka_example_controllers {

namespace {

using franka_hw::ControlMode;
using franka_hw::ResourceClaims;

constexpr char kArm[] = "arm";
constexpr uint8_t kJoints = 7;

struct Interface {
  const char* name;
  uint8_t ResourceClaims::* counter;
  uint8_t claims;  // of one controller
};

constexpr Interface kInterfaces[] = {
    {"joint_position", &ResourceClaims::joint_position_claims, kJoints},
    {"joint_velocity", &ResourceClaims::joint_velocity_claims, kJoints},
    {"cartesian_pose", &ResourceClaims::cartesian_pose_claims, 1},
    {"cartesian_velocity", &ResourceClaims::cartesian_velocity_claims, 1},
    {"effort", &ResourceClaims::joint_torque_claims, kJoints},
};

}  // namespace

CommandClaims checkCommandClaims(const std::vector<std::string>& names) {
  if (names.empty()) {
    return {ControlMode::None,
            "No command interface is named; there are joint_position, "
            "joint_velocity, cartesian_pose, cartesian_velocity and effort."};
  }
  franka_hw::ArmClaimedMap claims;
  for (const std::string& name : names) {
    const auto* const interface =
        std::find_if(std::begin(kInterfaces), std::end(kInterfaces),
                     [&](const Interface& known) { return name == known.name; });
    if (interface == std::end(kInterfaces)) {
      return {ControlMode::None, "There is no command interface '" + name +
                                     "'; there are joint_position, joint_velocity, cartesian_pose, "
                                     "cartesian_velocity and effort."};
    }
    uint8_t& counter = claims[kArm].*interface->counter;
    if (counter > 0) {
      return {ControlMode::None, "The command interface '" + name + "' is named twice."};
    }
    counter = interface->claims;
  }
  const ControlMode mode = franka_hw::getControlMode(kArm, claims);
  if (mode == ControlMode::None) {
    return {mode,
            "An arm follows one motion at a time: name one of joint_position, "
            "joint_velocity, cartesian_pose and cartesian_velocity, alone or with effort."};
  }
  return {mode, ""};
}

}  // namespace franka_example_controllers
