// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_hw/control_mode.h>
#include <franka_sim_mujoco/arm_commands.h>

namespace franka_core {
struct MotionLimits;
}

namespace franka_sim_mujoco {

inline bool contains(franka_hw::ControlMode mode, franka_hw::ControlMode part) noexcept {
  return (mode & part) != franka_hw::ControlMode::None;
}

/// Processing of commands between controllers and robot, as in libfranka's control loops: the
/// parameters of the same names of franka_hw.
struct ShapingOptions {
  bool rate_limiting{true};        ///< keep motions within the robot's limits
  double cutoff_frequency{100.0};  ///< of the low-pass filter [Hz]; from 1000 on: off
  /// Whether torques are filtered and limited too: a robot with reflexes requires it, the
  /// simulation without reflexes passes torques unchanged.
  bool torques{false};
};

/// Makes the command of a tick from the controllers' commands.
///
/// Filters and limits each kind of command in the mode against the state that it answers, in that
/// order. Values that are not finite pass unchanged, and a pose that is not a transform after the
/// filter is not limited: the robot checks it. A pure function. Real-time safe.
/// @param mode the claims @param state k, which the command answers
/// @param limits the robot's limits of motions
franka_core::RobotCommand shapeCommand(const ShapingOptions& options, franka_hw::ControlMode mode,
                                       const ArmCommands& desired,
                                       const franka_core::RobotState& state,
                                       const franka_core::MotionLimits& limits) noexcept;

}  // namespace franka_sim_mujoco
