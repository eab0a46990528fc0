// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_core/robot_versions.h>

#include <utility>

namespace franka {

namespace {

// Explains two version numbers, and gives advice.
std::string adviceFor(uint16_t server_version, uint16_t library_version) {
  const auto& oldest = franka_core::kRobotVersions.front();
  const auto& newest = franka_core::kRobotVersions.back();
  if (library_version != newest.version) {
    // A gripper's protocol is not in the table.
    return "Please update the robot's system or the library so that both match.";
  }
  if (server_version < oldest.version) {
    return std::string(
               "The robot's system is older than any this library knows. Please update it: "
               "at least to ") +
           oldest.system + " on a " + oldest.robot + ".";
  }
  if (server_version > newest.version) {
    return std::string("The robot's system is newer than any this library knows (the newest is ") +
           newest.robot + ", system " + newest.system +
           "). Please update this library, or install an earlier system on the robot.";
  }
  const franka_core::RobotVersion& robot = *franka_core::findRobotVersion(server_version);
  return std::string("The robot is a ") + robot.robot + " with system " + robot.system +
         ", for which libfranka " + robot.libraries +
         " was made. Please update the robot's system or the library so that both match.";
}

}  // namespace

IncompatibleVersionException::IncompatibleVersionException(uint16_t server_version,
                                                           uint16_t library_version) noexcept
    : Exception("libfranka: Robot and library speak different protocols (server version: " +
                std::to_string(server_version) +
                ", library version: " + std::to_string(library_version) + "). " +
                adviceFor(server_version, library_version)),
      server_version(server_version),
      library_version(library_version) {}

ControlException::ControlException(const std::string& what,
                                   std::vector<franka::Record> log) noexcept
    : Exception(what), log(std::move(log)) {}

}  // namespace franka
