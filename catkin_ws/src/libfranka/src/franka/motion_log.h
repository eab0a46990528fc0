// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/log.h>
#include <franka_core/abort_diagnosis.h>
#include <franka_core/robot_state.h>

#include <cstddef>
#include <vector>

namespace franka {

/// Keeps the last states and commands of a motion. Memory is taken at construction; add is for the
/// 1 kHz loop.
class MotionLog {
 public:
  /// A received state and the command sent just before it.
  using Entry = franka_core::AbortRecord;

  /// @param size how many entries are kept; may be 0.
  explicit MotionLog(std::size_t size) : ring_(size) {}

  /// Adds an entry in the place of the oldest.
  void add(const franka_core::RobotState& state, const franka_core::RobotCommand& command) noexcept;
  /// Everything kept, oldest first.
  std::vector<Entry> entries() const;

 private:
  std::vector<Entry> ring_;
  std::size_t count_{0};  // of all entries ever added
};

/// The same for users.
std::vector<Record> toRecords(const std::vector<MotionLog::Entry>& entries);

}  // namespace franka
