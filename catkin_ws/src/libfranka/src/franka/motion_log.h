// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/log.h>
#include <franka_core/abort_diagnosis.h>
#include <franka_core/robot_state.h>

#include <cstddef>
#include <vector>

namespace franka {

/// Stores the last states and commands of a motion. Memory is allocated at construction.
class MotionLog {
 public:
  /// A received state and the command sent just before it.
  using Entry = franka_core::AbortRecord;

  /// @param size number of entries; may be 0.
  explicit MotionLog(std::size_t size) : ring_(size) {}

  /// Adds an entry, replacing the oldest. Real-time safe.
  /// @param answer_time of the command [s]
  void add(const franka_core::RobotState& state, const franka_core::RobotCommand& command,
           double answer_time) noexcept;
  /// All entries, oldest first.
  std::vector<Entry> entries() const;

 private:
  std::vector<Entry> ring_;
  std::size_t count_{0};  // of all entries ever added
};

/// Converts entries to the public type.
std::vector<Record> toRecords(const std::vector<MotionLog::Entry>& entries);

}  // namespace franka
