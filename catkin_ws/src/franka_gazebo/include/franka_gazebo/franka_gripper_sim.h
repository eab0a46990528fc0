// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/franka_gripper_sim.h>

namespace franka_gazebo {

/// The original's constants. For the defaults used here see franka_sim_mujoco::GripperParameters
/// and GripperActionParameters.
constexpr double kMaxFingerWidth = 0.08;                       ///< [m]
constexpr double kDefaultMoveWidthTolerance = 0.001;           ///< [m]
constexpr double kDefaultGripperActionWidthTolerance = 0.005;  ///< [m]
constexpr double kDefaultGripperActionSpeed = 0.1;             ///< [m/s]
constexpr double kGraspRestingThreshold = 0.003;               ///< [m/s]
constexpr int kGraspConsecutiveSamples = 10;                   ///< default of the original

/// The simulated gripper, by the name that it has in franka_gazebo.
using FrankaGripperSim = franka_sim_mujoco::FrankaGripperSim;

}  // namespace franka_gazebo
