// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// Receiver of the library's messages.

namespace franka {

/// Receives messages; registered with franka::logging::addLogger. Its functions are called by any
/// thread, one at a time, and outside the control loop. They must not call franka::logging.
class LoggingSinkInterface {
 public:
  virtual ~LoggingSinkInterface() = default;

  /// Name for removeLogger. Must not change while it is registered.
  virtual std::string getName() const = 0;

  /// @name A message of each severity
  /// @{
  virtual void logInfo(const std::string& message) = 0;
  virtual void logWarn(const std::string& message) = 0;
  virtual void logError(const std::string& message) = 0;
  /// @}
};

}  // namespace franka
