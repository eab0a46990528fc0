// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <franka_core/robot_state.h>

#include "franka/arm_rate_limits.h"

namespace franka {

/// Settings for converting a callback's value into a command.
struct Shaping {
  const ArmRateLimits* limits;  ///< null: commands are not limited
  double cutoff_frequency;      ///< of the low-pass filter [Hz]; from kMaxCutoffFrequency on: none
  bool start_at_command;        ///< the reference for filter and limiter is the value itself
};

/// Each function filters a value against the state that it answers, limits it, checks it and writes
/// it into the command. Real-time safe.
/// @throws std::invalid_argument if a value is not finite, a pose is not a homogeneous
/// transformation, or an elbow's sign is neither +1 nor -1.
void shape(const Shaping& shaping, const Torques& torques, const franka_core::RobotState& state,
           franka_core::RobotCommand& command);
void shape(const Shaping& shaping, const JointPositions& positions,
           const franka_core::RobotState& state, franka_core::RobotCommand& command);
void shape(const Shaping& shaping, const JointVelocities& velocities,
           const franka_core::RobotState& state, franka_core::RobotCommand& command);
void shape(const Shaping& shaping, const CartesianPose& pose, const franka_core::RobotState& state,
           franka_core::RobotCommand& command);
void shape(const Shaping& shaping, const CartesianVelocities& velocities,
           const franka_core::RobotState& state, franka_core::RobotCommand& command);

/// For motions that the program drives itself: checks only.
constexpr Shaping kUnshaped{nullptr, 1000.0, false};

}  // namespace franka
