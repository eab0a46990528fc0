// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/log.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

/// @file
/// The family of exceptions; what() is a sentence for the user.

namespace franka {

/// Base of all.
struct Exception : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The robot's model cannot be loaded.
struct ModelException : public Exception {
  using Exception::Exception;
};

/// The connection failed, broke or timed out.
struct NetworkException : public Exception {
  using Exception::Exception;
};

/// The robot answered something that the protocol does not allow.
struct ProtocolException : public Exception {
  using Exception::Exception;
};

/// Robot and library speak different versions of the protocol.
struct IncompatibleVersionException : public Exception {
  /// @param server_version version of the robot. @param library_version version that this library
  /// requested.
  IncompatibleVersionException(uint16_t server_version, uint16_t library_version) noexcept;

  const uint16_t server_version;   ///< version of the robot
  const uint16_t library_version;  ///< version that this library requested
};

/// A motion was aborted.
struct ControlException : public Exception {
  /// @param what what happened. @param log the last states and commands, oldest first.
  explicit ControlException(const std::string& what, std::vector<franka::Record> log = {}) noexcept;

  const std::vector<franka::Record> log;  ///< the last states and commands, oldest first
};

/// The robot refused or aborted a command.
struct CommandException : public Exception {
  using Exception::Exception;
};

/// The thread could not get realtime priority, or the kernel does not support it.
struct RealtimeException : public Exception {
  using Exception::Exception;
};

/// The object is busy: another motion or read runs on it.
struct InvalidOperationException : public Exception {
  using Exception::Exception;
};

}  // namespace franka
