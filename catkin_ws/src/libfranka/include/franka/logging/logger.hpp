// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/logging/logging_sink_interface.hpp>
#include <memory>
#include <string>

/// @file
/// Messages that go to the sinks which the program registers. Without a sink they are dropped; only
/// the library's own warnings then go to standard error. All functions are thread-safe. Not
/// real-time safe.
///
///   franka::logging::addLogger(std::make_shared<franka::CoutLoggingSink>());

namespace franka::logging {

/// Registers a sink. Where one of the same name is registered already, that one stays.
/// @throws std::invalid_argument for a null pointer.
void addLogger(const std::shared_ptr<LoggingSinkInterface>& logger);
/// Removes the sink of this name, if there is one.
void removeLogger(const std::string& logger_name);
/// Removes all sinks.
void removeAllLoggers();

/// @name Messages to all sinks
/// @{
void logInfo(const std::string& message);
void logWarn(const std::string& message);
void logError(const std::string& message);
/// @}

}  // namespace franka::logging
