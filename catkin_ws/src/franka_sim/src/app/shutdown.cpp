// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "shutdown.h"

#include <algorithm>

namespace franka_sim {

void Shutdown::serve() {
  if (!requested_) {
    return;
  }
  const Clock::time_point now = Clock::now();
  requested_at_ = requested_at_.value_or(now);
  ended_ = !hasClients() || now - *requested_at_ >= patience_;
}

bool Shutdown::hasClients() const {
  return std::any_of(robots_.begin(), robots_.end(),
                     [](const fci::SimRobot* robot) { return robot->hasClients(); });
}

}  // namespace franka_sim
