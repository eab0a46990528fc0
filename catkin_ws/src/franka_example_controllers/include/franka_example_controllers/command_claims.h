// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/control_mode.h>

#include <string>
#include <vector>

namespace franka_example_controllers {

/// Meaning of a list of command interfaces for one arm.
struct CommandClaims {
  /// None if the list is refused.
  franka_hw::ControlMode mode{franka_hw::ControlMode::None};
  /// The reason, as a sentence; empty if the list is allowed.
  std::string refusal;
};

/// Checks names of command interfaces: `joint_position`, `joint_velocity`, `cartesian_pose`,
/// `cartesian_velocity` and `effort`. franka_hw's own rules define allowed combinations. Not for
/// the loop.
CommandClaims checkCommandClaims(const std::vector<std::string>& names);

/// Whether a mode contains one of these bits.
constexpr bool commands(franka_hw::ControlMode mode, franka_hw::ControlMode bits) {
  return (mode & bits) != franka_hw::ControlMode::None;
}

}  // namespace franka_example_controllers
