// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/limits.h>
#include <franka_core/numbers.h>

#include <array>

namespace franka_core::fci {

namespace {

// In the order of Command.
constexpr std::array<const char*, kCommandCount> kCommandNames{
    {"Connect", "Move", "Stop Move", "Get Cartesian Limit", "Set Collision Behavior",
     "Set Joint Impedance", "Set Cartesian Impedance", "Set Guiding Mode", "Set EE to K",
     "Set NE to EE", "Set Load", "Set Filters", "Automatic Error Recovery", "Load Model Library",
     "Get Robot Model"}};

constexpr const char* kDueToSafety =
    " due to activated safety function! Please disable all safety functions.";

bool isSetterOrGetter(Command command) noexcept {
  switch (command) {
    case Command::kConnect:
    case Command::kMove:
    case Command::kStopMove:
    case Command::kAutomaticErrorRecovery:
    case Command::kLoadModelLibrary:
    case Command::kGetRobotModel:
      return false;
    default:
      return true;
  }
}

// What makes the command possible. The question about the brakes is the genuine client's.
const char* remedy(RobotMode mode) noexcept {
  switch (mode) {
    case RobotMode::kOther:
      return " Did you open the brakes?";
    case RobotMode::kReflex:
      return " Recover first: automaticErrorRecovery, in ROS the action error_recovery.";
    case RobotMode::kUserStopped:
      return " Release the user stop first.";
    default:
      return "";
  }
}

std::string notPossible(RobotMode mode) {
  return std::string(" command rejected: command not possible in the current mode (\"") +
         modeName(mode) + "\")!" + remedy(mode);
}

// Appended to the genuine text: the valid values of an argument, for common mistakes.
std::string hint(Command command) {
  if (command != Command::kSetLoad) {
    return "";
  }
  return " Give mass [kg], center from the flange [m] and symmetric inertia [kg m^2] of what the "
         "arm "
         "can carry; simulated arms take at most " +
         franka_core::numberText(kMaxPayloadMass) + " kg, " +
         franka_core::numberText(kMaxPayloadDistance) + " m and " +
         franka_core::numberText(kMaxPayloadInertia) + " kg m^2.";
}

// Text after the command's name; empty for a status that is not a failure of this command.
std::string ending(Command command, Status status, RobotMode mode) {
  switch (status) {
    case Status::kCommandNotPossibleRejected:
      return notPossible(mode);
    case Status::kInvalidArgumentRejected:
      return command == Command::kMove ? " command rejected: maximum path deviation out of range!"
                                       : " command rejected: invalid argument!" + hint(command);
    case Status::kStartAtSingularPoseRejected:
      return " command rejected: cannot start at singular pose!";
    case Status::kPreempted:
      return " command preempted!";
    case Status::kReflexAborted:
      return " command aborted: motion aborted by reflex!";
    case Status::kEmergencyAborted:
      return " command aborted: User Stop pressed!";
    case Status::kInputErrorAborted:
      return " command aborted: invalid input provided!";
    case Status::kAborted:
      // The genuine client has no text for an aborted StopMove.
      return command == Command::kStopMove ? notPossible(mode) : " command aborted!";
    case Status::kManualErrorRecoveryRequiredRejected:
      return " command rejected: manual error recovery required!";
    case Status::kRejectedDueToActivatedSafetyFunctions:
      return std::string(" command rejected") + kDueToSafety +
             (isSetterOrGetter(command) ? " " : "");
    case Status::kPreemptedDueToActivatedSafetyFunctions:
      return std::string(" command preempted") + kDueToSafety;
    default:
      return "";
  }
}

}  // namespace

const char* commandName(Command command) noexcept {
  const auto index = static_cast<std::size_t>(command);
  return index < kCommandNames.size() ? kCommandNames[index] : "Unknown";
}

const char* modeName(RobotMode mode) noexcept {
  switch (mode) {
    case RobotMode::kOther:
      return "Other";
    case RobotMode::kIdle:
      return "Idle";
    case RobotMode::kMove:
      return "Move";
    case RobotMode::kGuiding:
      return "Guiding";
    case RobotMode::kReflex:
      return "Reflex";
    case RobotMode::kUserStopped:
      return "User stopped";
    case RobotMode::kAutomaticErrorRecovery:
      return "Automatic error recovery";
  }
  return "Unknown";
}

Meaning meaning(Status status) noexcept {
  switch (status) {
    case Status::kSuccess:
    case Status::kMotionStarted:
      return Meaning::kGood;
    case Status::kPreempted:
    case Status::kPreemptedDueToActivatedSafetyFunctions:
    case Status::kReflexAborted:
    case Status::kEmergencyAborted:
    case Status::kInputErrorAborted:
    case Status::kAborted:
      return Meaning::kAborted;
    default:
      return Meaning::kRejected;
  }
}

std::string statusText(Command command, Status status, RobotMode mode) {
  const std::string text = ending(command, status, mode);
  return text.empty() ? unexpectedResponse(command)
                      : std::string("libfranka: ") + commandName(command) + text;
}

std::string unexpectedResponse(Command command) {
  return std::string("libfranka: Unexpected response while handling ") + commandName(command) +
         " command!";
}

}  // namespace franka_core::fci
