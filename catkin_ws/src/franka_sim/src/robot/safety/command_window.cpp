// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/command_window.h"

namespace franka_sim {

void CommandWindow::record(bool received) noexcept {
  received_[next_] = received;
  next_ = (next_ + 1) % kSlots;
  if (seen_ < kSlots) {
    seen_++;
  }
}

double CommandWindow::rate() const noexcept {
  return seen_ == 0 ? 0.0 : static_cast<double>(received_.count()) / static_cast<double>(seen_);
}

void CommandWindow::clear() noexcept {
  received_.reset();
  next_ = 0;
  seen_ = 0;
}

}  // namespace franka_sim
