// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>

#include <utility>

namespace franka {

IncompatibleVersionException::IncompatibleVersionException(uint16_t server_version,
                                                           uint16_t library_version) noexcept
    : Exception("libfranka: Robot and library speak different protocols (server version: " +
                std::to_string(server_version) +
                ", library version: " + std::to_string(library_version) +
                "). Please update the robot's system or the library so that both match."),
      server_version(server_version),
      library_version(library_version) {}

ControlException::ControlException(const std::string& what,
                                   std::vector<franka::Record> log) noexcept
    : Exception(what), log(std::move(log)) {}

}  // namespace franka
