// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_error.h>

#include <array>
#include <optional>

namespace franka_sim {

/// The two errors of external torque control for which no rule is published; the rules are ours.
///
/// force_control_safety_violation: something outside drives a joint with more torque than its motor
/// can give, whichever collision thresholds are set.
/// force_controller_desired_force_tolerance_violation: the torque at the link side has missed the
/// commanded one by more than 10 Nm for 100 ms: a joint that does not do what it is told.
/// Real-time safe; one thread.
class ForceWatch {
 public:
  void restart() noexcept { missed_ = 0; }

  /// One tick. All [Nm]. @param tau_ext external torque @param achieved link-side torque without
  /// gravity @param desired the one commanded for that tick @param range of the motors
  std::optional<franka_core::RobotError> update(const std::array<double, 7>& tau_ext,
                                                const std::array<double, 7>& achieved,
                                                const std::array<double, 7>& desired,
                                                const std::array<double, 7>& range) noexcept;

 private:
  int missed_{0};  // [ticks]
};

}  // namespace franka_sim
