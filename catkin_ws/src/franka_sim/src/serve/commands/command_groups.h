// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/operator_commands.h>

#include <cstdint>

/// @file
/// The rows of the operator's table, by what they concern. What the handlers use outlives the
/// table.

namespace franka_sim {

/// In lock-step a line that makes an arm react lets so much time pass [ticks].
constexpr std::uint64_t kReaction = 500;

/// User stop, devices and buttons, brakes, FCI, operating mode, guiding, power, end effector.
void addSafetyCommands(fci::CommandTable& table, const OperatorContext& context);
/// Self-test, errors of the safety controller and their recovery.
void addErrorCommands(fci::CommandTable& table, const OperatorContext& context);
/// Load, virtual walls and motions by Desk.
void addRobotCommands(fci::CommandTable& table, const OperatorContext& context);
/// State, report and hash.
void addStateCommands(fci::CommandTable& table, const OperatorContext& context);
/// The Franka hand, or none.
void addHandCommands(fci::CommandTable& table, const OperatorContext& context);
/// The vacuum gripper, if the robot has one.
void addVacuumCommands(fci::CommandTable& table, const OperatorContext& context);
/// Quality of the link to the client.
void addLinkCommands(fci::CommandTable& table, const OperatorContext& context);
/// Bodies of the world, its time and its end; the world to draw.
void addWorldCommands(fci::CommandTable& table, const OperatorContext& context);

}  // namespace franka_sim
