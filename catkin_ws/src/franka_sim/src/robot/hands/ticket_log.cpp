// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/hands/ticket_log.h>

#include <algorithm>

namespace franka_sim {

TicketLog& TicketLog::operator=(const TicketLog& other) noexcept {
  entries_ = other.entries_;
  last_ = other.last_;
  issued_ = std::max(issued_, other.issued_);
  return *this;
}

TicketLog::Ticket TicketLog::open() noexcept {
  close(GripperOutcome::kInterrupted);
  last_ = ++issued_;
  entry(last_) = {last_, GripperOutcome::kRunning};
  return last_;
}

void TicketLog::close(GripperOutcome outcome) noexcept {
  if (isOpen()) {
    entry(last_).outcome = outcome;
  }
}

void TicketLog::renumber() noexcept {
  const Ticket last = last_;
  const GripperOutcome outcome = this->outcome(last);
  entries_ = {};
  if (last != 0) {
    last_ = ++issued_;
    entry(last_) = {last_, outcome};
  }
}

GripperOutcome TicketLog::outcome(Ticket ticket) const noexcept {
  if (ticket == 0 || ticket > issued_) {
    return GripperOutcome::kFailed;
  }
  const Entry& entry = entries_[ticket % kRemembered];
  return entry.ticket == ticket ? entry.outcome : GripperOutcome::kInterrupted;
}

}  // namespace franka_sim
