// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/fci/sim_robot.h>
#include <franka_sim/robot/protocols.h>

#include <optional>
#include <string>

/// @file
/// Sets up the network servers of a Panda or an FR3, for every program that runs a world.

namespace franka_sim::fci {

/// Servers at an address of this machine, with the models of the arm that clients request.
RobotServerParameters servedAt(const std::string& address, const ProtocolRange& protocols,
                               const franka_core::ArmModel& arm);

/// A hand to serve, with the gains of its fingers. @param fingers outlive the robot
SimRobot::Hand servedHand(HandPlant& fingers, const GripperLatency& latency);

/// A robot that behaves as behind its own interface, of its newest protocol.
/// @param unit the robot's own configuration, as the user enters it in Desk
/// @param arm outlives the robot @param command_delay of every command [ticks]
/// @throws as SimRobot
SimRobot servedRobot(const std::string& address, const ProtocolRange& protocols,
                     ControlUnitParameters unit, ArmPlant& arm,
                     const std::optional<SimRobot::Hand>& hand,
                     const std::optional<SimRobot::Vacuum>& vacuum = {},
                     unsigned command_delay = 0);

/// The two links that came too close, named as in the description without the arm's name: "link2
/// and hand".
std::string linksOf(const SelfCollision::Pair& pair);

/// Sets the load as the user does in Desk.
/// @throws std::runtime_error with a sentence when the robot refuses it
void setLoad(SimRobot& robot, const franka_core::Payload& load);

/// Message about a collision that raised this error (self-collision, joint or Cartesian reflex):
/// "it met something, joint 4: external torque 23.4 Nm, upper threshold 20 Nm".
std::string collisionOf(const ControlUnit& unit, franka_core::RobotError error);

/// The links or the axis of a collision that raised this error (an index of RobotState::errors);
/// empty for other errors.
std::string detailOf(const ControlUnit& unit, std::size_t error);

/// Mode, client, errors (of collisions: the links or the axis) and joints in one line for the user.
std::string describe(SimRobot& robot);

}  // namespace franka_sim::fci
