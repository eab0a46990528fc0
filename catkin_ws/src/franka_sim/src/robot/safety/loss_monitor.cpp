// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/loss_monitor.h"

namespace franka_sim {

bool LossMonitor::record(bool received, int patience) noexcept {
  begun_ = begun_ || received;
  lost_ = received ? 0 : lost_ + 1;
  if (!begun_) {
    return lost_ >= patience;
  }
  window_.record(received);
  return lost_ >= kLostInARow;
}

void LossMonitor::restart() noexcept {
  window_.clear();
  lost_ = 0;
  begun_ = false;
}

}  // namespace franka_sim
