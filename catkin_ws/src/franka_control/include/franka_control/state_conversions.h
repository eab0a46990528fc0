// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_msgs/FrankaState.h>
#include <geometry_msgs/Transform.h>

#include <array>

namespace franka_control {

/// Copies every field of a robot state into a message, except its header. Frames, units and layouts
/// are the same on both sides; time is in [s]. Real-time safe.
void toMessage(const franka::RobotState& state, franka_msgs::FrankaState& message) noexcept;

/// Converts a 4x4 column-major transform to a translation and a unit quaternion. Rotations that are
/// not exactly orthonormal, such as values typed with four digits, are normalized. Real-time safe.
geometry_msgs::Transform toTransform(const std::array<double, 16>& transform) noexcept;

}  // namespace franka_control
