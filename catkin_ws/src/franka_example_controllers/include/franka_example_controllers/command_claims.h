// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/control_mode.h>

#include <string>
#include <vector>

namespace franka_example_controllers {

/// What a list of command interfaces amounts to on one arm.
struct CommandClaims {
  /// None when the list is refused.
  franka_hw::ControlMode mode{franka_hw::ControlMode::None};
  /// Why, as a sentence; empty when the list is allowed.
  std::string refusal;
};

/// Checks names of command interfaces: `joint_position`, `joint_velocity`, `cartesian_pose`,
/// `cartesian_velocity` and `effort`. What may stand together is decided by franka_hw's own rules.
/// Not for the loop.
CommandClaims checkCommandClaims(const std::vector<std::string>& names);

/// Whether a mode has any of some bits.
constexpr bool commands(franka_hw::ControlMode mode, franka_hw::ControlMode bits) {
  return (mode & bits) != franka_hw::ControlMode::None;
}

}  // namespace franka_example_controllers
