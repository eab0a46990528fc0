// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace franka_sim {

/// Outcome of a gripper command.
enum class GripperOutcome {
  kRunning,
  kSucceeded,  ///< arrived, or holds an object within the epsilons
  kFailed,  ///< refused, or ended at another width than commanded (obstacle, no object or another
            ///< one grasped)
  kInterrupted,  ///< another command or stop() came first
};

/// Numbers commands and stores the outcomes of the last ones. At most one runs at a time: opening a
/// new one interrupts it. Called by one thread. Real-time safe.
class TicketLog {
 public:
  using Ticket = std::uint64_t;
  static constexpr std::size_t kRemembered = 16;

  TicketLog() = default;
  TicketLog(const TicketLog&) = default;
  /// Takes over the outcomes of an earlier state of this log. Commands that were given since count
  /// as interrupted, and their numbers are not given again.
  TicketLog& operator=(const TicketLog& other) noexcept;
  ~TicketLog() = default;

  Ticket open() noexcept;
  /// Ends the running command, if any.
  void close(GripperOutcome outcome) noexcept;
  /// Whether a command runs.
  bool isOpen() const noexcept { return outcome(last_) == GripperOutcome::kRunning; }
  /// Call after the log of another hand was taken over: commands that this hand was given before
  /// count as interrupted; the last one of the other hand gets a number that this log has not
  /// given.
  void renumber() noexcept;
  /// kFailed for 0 and for unknown numbers; kInterrupted for those no longer stored.
  GripperOutcome outcome(Ticket ticket) const noexcept;

 private:
  struct Entry {
    Ticket ticket{0};
    GripperOutcome outcome{GripperOutcome::kRunning};
  };

  Entry& entry(Ticket ticket) noexcept { return entries_[ticket % kRemembered]; }

  Ticket last_{0};    ///< of the command that was given last
  Ticket issued_{0};  ///< the largest number that was given
  std::array<Entry, kRemembered> entries_{};
};

}  // namespace franka_sim
