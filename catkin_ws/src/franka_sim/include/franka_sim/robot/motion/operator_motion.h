// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/fixed_pointer.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace franka_sim {

/// Joint motions that the operator starts by Desk: from rest to rest, by smoothStep, within the
/// limits of the joints, by the unit's joint impedance controller. Where the velocity limit of an
/// FR3's joint falls faster than smoothStep slows down, the way's time passes more slowly.
/// Called by one thread. Real-time safe.
class OperatorMotion {
 public:
  /// @param unit outlives the motion.
  explicit OperatorMotion(ControlUnit& unit) noexcept : unit_(&unit) {}

  /// The pose in which an arm is packed [rad]. Chosen here, as Franka does not publish its own:
  /// folded above the shoulder, within the limits of a Panda and of an FR3.
  static constexpr std::array<double, 7> kPackPose{0.0, -0.56, 0.0, -2.95, 0.0, 2.4, M_PI_4};

  /// @param q target [rad], which the joints can reach @param speed share of the joints' velocity
  /// limits, above 0, at most 1
  /// @returns the answer to the unit's Move request; kInvalidArgumentRejected for an invalid target
  Status start(const std::array<double, 7>& q, double speed) noexcept;
  /// Brakes. The motion has then not arrived.
  void stop() noexcept;
  /// The command of this tick; nullptr if no motion runs.
  const franka_core::RobotCommand* command() noexcept;

  bool active() const noexcept { return active_; }
  /// Whether the last motion has reached its target.
  bool arrived() const noexcept { return arrived_; }

  /// The first joint (0 to 6) that cannot go from where the arm is to q [rad]; none if all can.
  std::optional<std::size_t> jointOutOfReach(const std::array<double, 7>& q) const noexcept;

 private:
  double shortestDuration(double speed) const noexcept;
  double velocityLimit(std::size_t joint, double q) const noexcept;
  double farthestShare() const noexcept;
  double nextTime() const noexcept;

  FixedPointer<ControlUnit> unit_;
  std::array<double, 7> from_{}, to_{};
  double time_{0.0}, duration_{0.0};  // [s]
  bool active_{false}, arrived_{false};
  franka_core::RobotCommand command_;
};

}  // namespace franka_sim
