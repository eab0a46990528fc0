// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>

#include <string>

/// @file
/// The genuine client's texts about a reply, word for word (protocol 3.4). Not real-time safe.
/// Exceptions: the functions that return no string.

namespace franka_core::fci {

/// "Move", "Set EE to K", ...
const char* commandName(Command command) noexcept;

/// The mode's name without quotes: "Idle", "User stopped", ...
const char* modeName(RobotMode mode) noexcept;

/// Meaning of a status for the client.
enum class Meaning : std::uint8_t {
  kGood,      ///< success, or a motion has started
  kRejected,  ///< nothing happened: CommandException
  kAborted,   ///< ended early: ControlException in a control loop, else CommandException
};
Meaning meaning(Status status) noexcept;

/// The text of the exception for a failure, starting with "libfranka: ". `mode` is the robot's mode
/// at the time of the reply. For other statuses the text of unexpectedResponse.
std::string statusText(Command command, Status status, RobotMode mode);

/// "libfranka: Unexpected response while handling <name> command!", of a ProtocolException.
std::string unexpectedResponse(Command command);

/// Start of the text about a reflex after the client has already commanded the motion finished.
constexpr const char* kStillMoving = "Motion finished commanded, but the robot is still moving!";

/// Texts of connections.
constexpr const char* kConnectionRefused =
    "libfranka: Connection to FCI refused. Please install FCI feature or enable FCI mode in Desk.";
constexpr const char* kConnectionTimeout =
    "libfranka: Connection timeout. Please check your network connection or settings.";
constexpr const char* kServerClosed = "libfranka: server closed connection";
constexpr const char* kStateTimeout = "libfranka: UDP receive: Timeout";
constexpr const char* kWrongObjectSize = "libfranka: incorrect object size";

/// Texts of conflicting operations.
constexpr const char* kOtherOperationRunning =
    "libfranka robot: Cannot perform this operation while another control or read operation is "
    "running.";
constexpr const char* kMultipleMotions = "libfranka robot: Attempted to start multiple motions!";

/// Texts of the gripper ("libfranka gripper: ...") and the vacuum gripper ("libfranka vacuum
/// gripper: ...") are kGripper or kVacuumGripper followed by one of the endings.
constexpr const char* kGripper = "libfranka gripper: ";
constexpr const char* kVacuumGripper = "libfranka vacuum gripper: ";
constexpr const char* kGripperFailed = "Command failed!";
constexpr const char* kGripperAborted = "Command aborted!";

}  // namespace franka_core::fci
