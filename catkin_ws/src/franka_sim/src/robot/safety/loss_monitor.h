// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/safety/command_window.h"

namespace franka_sim {

/// Counts received and lost commands of a motion (protocol 5.3). Called by one thread.
/// Real-time safe.
class LossMonitor {
 public:
  /// This many lost commands in a row end a motion.
  static constexpr int kLostInARow = 20;

  /// One tick. Before a motion's first command nothing counts as lost: the client receives states
  /// without answering while it starts (protocol 5.2). @param patience ticks to wait for that first
  /// command @returns whether the client is lost.
  bool record(bool received, int patience = kPatience) noexcept;
  double rate() const noexcept { return window_.rate(); }
  void restart() noexcept;

 private:
  static constexpr int kPatience = 1000;  // [ticks], chosen here: the client's own UDP timeout

  CommandWindow window_;
  int lost_{0};
  bool begun_{false};
};

}  // namespace franka_sim
