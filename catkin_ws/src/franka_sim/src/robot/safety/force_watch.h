// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "robot/limits/error_set.h"

namespace franka_sim {

/// Two errors of external torque control. Their rules are not published; these are chosen here.
///
/// force_control_safety_violation: an external torque on a joint exceeds what its motor can give,
/// whatever the collision thresholds are.
/// force_controller_desired_force_tolerance_violation: the link-side torque has missed the
/// commanded one by more than 10 Nm for 100 ms: the joint does not follow its command. Called by
/// one thread. Real-time safe.
class ForceWatch {
 public:
  void restart() noexcept { missed_ = 0; }

  /// One tick. All [Nm]. @param tau_ext external torque @param achieved link-side torque without
  /// gravity @param desired the one commanded for that tick @param range of the motors
  ErrorSet update(const std::array<double, 7>& tau_ext, const std::array<double, 7>& achieved,
                  const std::array<double, 7>& desired,
                  const std::array<double, 7>& range) noexcept;

 private:
  int missed_{0};  // [ticks]
};

}  // namespace franka_sim
