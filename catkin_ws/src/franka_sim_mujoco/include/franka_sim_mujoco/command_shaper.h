// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_hw/control_mode.h>
#include <franka_sim/robot/motion/motion_limits.h>
#include <franka_sim_mujoco/arm_commands.h>

namespace franka_sim_mujoco {

inline bool contains(franka_hw::ControlMode mode, franka_hw::ControlMode part) noexcept {
  return (mode & part) != franka_hw::ControlMode::None;
}

/// How commands are treated on their way from the controllers to the robot, as by libfranka's
/// control loops: the parameters of the same names of franka_hw.
struct ShapingOptions {
  bool rate_limiting{true};        ///< keep motions within the robot's limits
  double cutoff_frequency{100.0};  ///< of the low-pass filter [Hz]; from 1000 on: none
  /// Whether torques are filtered and limited too: a robot with reflexes demands it, the simulation
  /// without them hands torques on as they are.
  bool torques{false};
};

/// Makes the command of a tick of what the controllers want.
///
/// Filters and limits each kind of command that the mode contains against the state it answers, in
/// that order. What is not finite is handed on as it is, and a pose that is no transform after the
/// filter is not limited: the robot judges it. Real-time safe; pure.
/// @param mode what is claimed @param state k, that the command answers
/// @param limits what the robot holds motions to
franka_core::RobotCommand shapeCommand(const ShapingOptions& options, franka_hw::ControlMode mode,
                                       const ArmCommands& wanted,
                                       const franka_core::RobotState& state,
                                       const franka_sim::MotionLimits& limits) noexcept;

}  // namespace franka_sim_mujoco
