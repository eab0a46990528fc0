// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/logging/logging_sink_interface.hpp>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

/// @file
/// Messages for the sinks that the program registers. Without a sink only the library's own
/// warnings are written, to standard error. Thread-safe. Not real-time safe.
///
///   franka::logging::addLogger(std::make_shared<franka::CoutLoggingSink>());

namespace franka::logging {

/// Registers a sink. If one of the same name is already registered, that one stays.
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

/// Replaces the placeholders of a text in order: each `{}`, also one with a format such as
/// `{:.3f}`, which is not applied. `{{` and `}}` mean braces. Placeholders without a value stay.
std::string fill(const std::string& text, const std::vector<std::string>& values);

/// A value as written by `std::ostream`.
template <typename Value>
std::string toText(const Value& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// @name Messages with values, as fill writes them
/// @{
template <typename First, typename... Rest>
void logInfo(const std::string& text, const First& first, const Rest&... rest) {
  logInfo(fill(text, {toText(first), toText(rest)...}));
}
template <typename First, typename... Rest>
void logWarn(const std::string& text, const First& first, const Rest&... rest) {
  logWarn(fill(text, {toText(first), toText(rest)...}));
}
template <typename First, typename... Rest>
void logError(const std::string& text, const First& first, const Rest&... rest) {
  logError(fill(text, {toText(first), toText(rest)...}));
}
/// @}

}  // namespace franka::logging
