// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/ticket_log.h>

namespace franka_sim {

TicketLog::Ticket TicketLog::open() noexcept {
  close(GripperOutcome::kInterrupted);
  last_++;
  outcomes_[last_ % kRemembered] = GripperOutcome::kRunning;
  return last_;
}

void TicketLog::close(GripperOutcome outcome) noexcept {
  GripperOutcome& last = outcomes_[last_ % kRemembered];
  if (last_ != 0 && last == GripperOutcome::kRunning) {
    last = outcome;
  }
}

GripperOutcome TicketLog::outcome(Ticket ticket) const noexcept {
  if (ticket == 0 || ticket > last_) {
    return GripperOutcome::kFailed;
  }
  if (last_ - ticket >= kRemembered) {
    return GripperOutcome::kInterrupted;
  }
  return outcomes_[ticket % kRemembered];
}

}  // namespace franka_sim
