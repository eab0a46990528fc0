// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <type_traits>

namespace franka_hw {

/// Which kinds of command the running controllers send to one arm, as bits.
enum class ControlMode {
  None = 0,
  JointTorque = (1 << 0),
  JointPosition = (1 << 1),
  JointVelocity = (1 << 2),
  CartesianVelocity = (1 << 3),
  CartesianPose = (1 << 4),
};

constexpr ControlMode operator&(ControlMode left, ControlMode right) {
  using Bits = std::underlying_type_t<ControlMode>;
  return static_cast<ControlMode>(static_cast<Bits>(left) & static_cast<Bits>(right));
}

constexpr ControlMode operator|(ControlMode left, ControlMode right) {
  using Bits = std::underlying_type_t<ControlMode>;
  return static_cast<ControlMode>(static_cast<Bits>(left) | static_cast<Bits>(right));
}

constexpr ControlMode operator^(ControlMode left, ControlMode right) {
  using Bits = std::underlying_type_t<ControlMode>;
  return static_cast<ControlMode>(static_cast<Bits>(left) ^ static_cast<Bits>(right));
}

constexpr ControlMode operator~(ControlMode mode) {
  using Bits = std::underlying_type_t<ControlMode>;
  return static_cast<ControlMode>(~static_cast<Bits>(mode));
}

constexpr ControlMode& operator&=(ControlMode& left, ControlMode right) {
  return left = left & right;
}

constexpr ControlMode& operator|=(ControlMode& left, ControlMode right) {
  return left = left | right;
}

/// Prints `<none>` or the set bits' names, separated by a comma and a space, in the order
/// joint_torque, joint_position, joint_velocity, cartesian_velocity, cartesian_pose.
std::ostream& operator<<(std::ostream& stream, ControlMode mode);

}  // namespace franka_hw
