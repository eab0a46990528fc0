// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/fci/sim_robot.h>

#include <cstdint>
#include <optional>
#include <string>

/// @file
/// How a Panda or an FR3 is put on the network, whoever runs the world it lives in.

namespace franka_sim::fci {

/// Protocol versions that a robot speaks.
struct ProtocolRange {
  std::uint16_t oldest, newest;
};

/// All versions of a robot's generation (decision 25). @param robot "fr3"; all else is a Panda
ProtocolRange protocolsOf(const std::string& robot) noexcept;

/// The network face at an address of this machine, with the models of the arm that clients ask for.
RobotServerParameters servedAt(const std::string& address, const ProtocolRange& protocols,
                               const franka_core::ArmModel& arm);

/// A robot that behaves as behind its own interface, of its newest protocol.
/// @param unit the robot's own configuration, as the user enters it in Desk
/// @param arm outlives the robot, as do the fingers @param fingers null: no hand is served
/// @throws as SimRobot
SimRobot servedRobot(const std::string& address, const ProtocolRange& protocols,
                     ControlUnitParameters unit, ArmPlant& arm, HandPlant* fingers,
                     const std::optional<SimRobot::Vacuum>& vacuum = {});

/// Which links came too close, as the description calls them without the arm's name: "link2 and
/// hand".
std::string linksOf(const SelfCollision::Pair& pair);

/// What the user enters in Desk.
/// @throws std::runtime_error with a sentence when the robot refuses it
void setLoad(SimRobot& robot, const franka_core::Payload& load);

/// What the user is told of a collision that raised this error (self-collision, joint or Cartesian
/// reflex): "it met something, joint 4: external torque 23.4 Nm, upper threshold 20 Nm".
std::string collisionOf(const ControlUnit& unit, ErrorFlag error);

/// Mode, client, errors (of collisions: what met what) and joints in one line for the user.
std::string describe(SimRobot& robot);

}  // namespace franka_sim::fci
