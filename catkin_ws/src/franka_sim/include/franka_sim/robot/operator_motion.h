// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit.h>

#include <array>

namespace franka_sim {

/// Joint motions that the operator starts by Desk: from rest to rest, within the limits of the
/// joints, by the unit's joint impedance controller. Called by one thread. Real-time safe.
class OperatorMotion {
 public:
  /// @param unit outlives the motion.
  explicit OperatorMotion(ControlUnit& unit) noexcept : unit_(unit) {}

  /// The pose in which an arm is packed [rad]. Chosen here: Franka does not publish its own.
  static std::array<double, 7> packPose(bool fr3) noexcept;

  /// @param q target [rad], within the limits of the joints @param speed share of the joints'
  /// velocity limits, above 0, at most 1
  /// @returns the answer to the unit's Move request; kInvalidArgumentRejected for an invalid target
  Status start(const std::array<double, 7>& q, double speed) noexcept;
  /// Brakes. The motion has then not arrived.
  void stop() noexcept;
  /// The command of this tick; nullptr if no motion runs.
  const franka_core::RobotCommand* command() noexcept;

  bool active() const noexcept { return active_; }
  /// Whether the last motion has reached its target.
  bool arrived() const noexcept { return arrived_; }

 private:
  double shortestDuration(double speed) const noexcept;

  ControlUnit& unit_;
  std::array<double, 7> from_{}, to_{};
  double time_{0.0}, duration_{0.0};  // [s]
  bool active_{false}, arrived_{false};
  franka_core::RobotCommand command_;
};

}  // namespace franka_sim
