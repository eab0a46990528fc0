// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <cmath>
#include <string>

namespace franka_sim {

struct RobotDescription;

/// Reads franka_description's physics.yaml.
/// @param robot_type its section: "panda" or "fr3"
/// @param friction_set "none", "fr3"; see the file
/// @throws std::runtime_error with the file and the error
JointPhysics readJointPhysics(const std::string& file, const std::string& robot_type,
                              const std::string& friction_set);

/// Sets the properties for the joints <arm_id>_joint1 to 7.
void applyJointPhysics(const JointPhysics& physics, const std::string& arm_id,
                       RobotDescription& description);

/// Start pose of the arms of franka_sim and of the original's launch files [rad].
constexpr std::array<double, 7> kReadyPose{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4};

/// Makes q [rad] the initial positions of these joints.
void startAt(const std::array<double, 7>& q, const std::string& arm_id,
             RobotDescription& description);

/// Moves the initial positions of these joints to where a real arm rests after a motion to them:
/// its model of gravity is wrong by a few tenths of a newton metre, which the stiffness [Nm/rad] of
/// the hold turns into about 1e-4 rad (docs/fidelity.md). Clients are never tested with a position
/// that equals its target to the last bit. Joints without an initial position do not change.
void comeToRest(const std::array<double, 7>& stiffness, const std::string& arm_id,
                RobotDescription& description);

}  // namespace franka_sim
