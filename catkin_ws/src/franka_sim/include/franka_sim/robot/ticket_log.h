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
  kSucceeded,    ///< arrived, or holds an object within the epsilons
  kFailed,       ///< refused, or ended elsewhere than asked (obstacle, nothing or the wrong thing
                 ///< grasped)
  kInterrupted,  ///< another command or stop() came first
};

/// Numbers commands and stores the outcomes of the last ones. At most one runs at a time: opening a
/// new one interrupts it. Real-time safe; one thread.
class TicketLog {
 public:
  using Ticket = std::uint64_t;
  static constexpr std::size_t kRemembered = 16;

  Ticket open() noexcept;
  /// Ends the running command, if any.
  void close(GripperOutcome outcome) noexcept;
  /// Whether a command runs.
  bool isOpen() const noexcept { return outcome(last_) == GripperOutcome::kRunning; }
  /// kFailed for 0 and for unknown numbers; kInterrupted for those no longer stored.
  GripperOutcome outcome(Ticket ticket) const noexcept;

 private:
  Ticket last_{0};
  std::array<GripperOutcome, kRemembered> outcomes_{};
};

}  // namespace franka_sim
