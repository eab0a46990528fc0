// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/hands/gripper_unit.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/robot/sensor_physics.h>

#include <array>
#include <cmath>
#include <string>

namespace franka_sim {

/// The physics of one robot.
struct RobotPhysics {
  JointPhysics joints;                     ///< friction and more
  SensorPhysics sensors;                   ///< noise and more
  std::array<double, 7> torque_offset{};   ///< of the torque sensors [Nm]
  std::array<LinkError, 8> link_errors{};  ///< of the links 1 to 8, the flange
  GripperLatency gripper;                  ///< of the hand
  unsigned command_delay{0};               ///< [ms]
};

/// Reads franka_description's physics.yaml, then the realism's own file.
/// @param robot_type its section: "panda" or "fr3"
/// @throws std::runtime_error with the file and the error
RobotPhysics readRobotPhysics(const std::string& file, const std::string& robot_type,
                              const Realism& realism);

/// Sets the properties for the joints `<arm_id>_joint1` to 7 and the links `<arm_id>_link1` to 8.
void applyPhysics(const RobotPhysics& physics, const std::string& arm_id,
                  RobotDescription& description);

/// Sets the control unit's motor parameters and the errors of its sensors.
void applyPhysics(const RobotPhysics& physics, ControlUnitParameters& parameters);

/// Start pose of the arms of franka_sim and of the original's launch files [rad].
constexpr std::array<double, 7> kReadyPose{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4};

/// Makes q [rad] the initial positions of these joints.
void setInitialPositions(const std::array<double, 7>& q, const std::string& arm_id,
                         RobotDescription& description);

/// Moves the initial positions of these joints to where a real arm rests after a motion to them:
/// its model of gravity is wrong by a few tenths of a newton meter, which the stiffness [Nm/rad] of
/// the hold turns into about 1e-4 rad (docs/fidelity.md). Clients are never tested with a position
/// that equals its target to the last bit. Joints without an initial position do not change.
void applyRestOffset(const std::array<double, 7>& stiffness, const std::string& arm_id,
                     RobotDescription& description);

}  // namespace franka_sim
