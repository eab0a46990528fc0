// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/logging/logging_sink_interface.hpp>
#include <string>

/// @file
/// Messages on the terminal.

namespace franka {

/// Writes each message as one line to standard output: "INFO: ...", "WARNING: ..." or "ERROR: ...".
class CoutLoggingSink : public LoggingSinkInterface {
 public:
  /// "CoutLoggingSink".
  std::string getName() const override;

  void logInfo(const std::string& message) override;
  void logWarn(const std::string& message) override;
  void logError(const std::string& message) override;
};

}  // namespace franka
