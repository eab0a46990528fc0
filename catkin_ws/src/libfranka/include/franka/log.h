// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <franka/robot_state.h>

#include <string>
#include <vector>

/// @file
/// The log of the last milliseconds of a motion.

namespace franka {

/// The command sent for a state. Unused values are zero.
struct RobotCommand {
  JointPositions joint_positions{std::array<double, 7>{}};            ///< [rad]
  JointVelocities joint_velocities{std::array<double, 7>{}};          ///< [rad/s]
  CartesianPose cartesian_pose{std::array<double, 16>{}};             ///< pose in O
  CartesianVelocities cartesian_velocities{std::array<double, 6>{}};  ///< twist in O
  Torques torques{std::array<double, 7>{}};                           ///< [Nm]
};

/// A received state and the command that had been sent just before it.
struct Record {
  RobotState state;      ///< received state
  RobotCommand command;  ///< command sent before
};

/// The log as comma separated values: a header line, then one line a record; time in [ms],
/// everything else in the units of RobotState. Not real-time safe.
/// @returns an empty string for an empty log.
std::string logToCSV(const std::vector<Record>& log);

}  // namespace franka
