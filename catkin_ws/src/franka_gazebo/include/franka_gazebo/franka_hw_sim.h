// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_gazebo/controller_verifier.h>
#include <franka_gazebo/joint.h>
#include <franka_gazebo/model_kdl.h>
#include <franka_gazebo/statemachine.h>
#include <franka_sim_mujoco/franka_hw_sim.h>

namespace franka_gazebo {

constexpr double kDefaultTauExtLowpassFilter = 1.0;  ///< no filter

/// The original's name. Its base class franka_sim_mujoco::RobotHWSim has the interface of
/// gazebo_ros_control's, with the simulation's handle of the robot instead of Gazebo's model.
using FrankaHWSim = franka_sim_mujoco::FrankaHWSim;

}  // namespace franka_gazebo
