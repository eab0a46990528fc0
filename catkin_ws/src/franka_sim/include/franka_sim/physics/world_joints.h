// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/robot/plant.h>

#include <string>

/// @file
/// Functions that read and change the joints with one degree of freedom of a World by their names.
/// The thread that uses the world calls them, between ticks. All throw std::runtime_error with a
/// sentence for an unknown name; those that change something also while the world has stopped
/// (World::stopped), and for numbers beyond the limits of input_limits.h. Not real-time safe.

namespace franka_sim {

JointMeasurement jointState(const World& world, const std::string& joint);  ///< with its torque
/// @throws std::runtime_error if such a position cannot be set
void checkJointPosition(const World& world, const std::string& joint, double position);
/// Teleports; velocity becomes 0.
void setJointPosition(World& world, const std::string& joint, double position);
void setJointVelocity(World& world, const std::string& joint, double velocity);  ///< [rad/s], [m/s]

}  // namespace franka_sim
