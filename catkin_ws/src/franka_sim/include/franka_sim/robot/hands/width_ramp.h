// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// The desired width of a hand on its way to a target: accelerates and brakes at a constant rate,
/// so that the fingers neither jerk nor overshoot. Widths [m], speeds of the width [m/s]. Called by
/// one thread. Real-time safe.
class WidthRamp {
 public:
  /// Starts at rest at `width`. @param speed not negative; with zero it never arrives.
  void start(double width, double target, double speed) noexcept;
  /// Rests at a width.
  void hold(double width) noexcept { start(width, width, 0.0); }
  /// One tick. @param period [s]
  void step(double period) noexcept;

  double width() const noexcept { return width_; }
  double target() const noexcept { return target_; }
  double velocity() const noexcept { return velocity_; }
  bool arrived() const noexcept { return width_ == target_; }

 private:
  double width_{0.0};
  double target_{0.0};
  double speed_{0.0};
  double velocity_{0.0};
};

}  // namespace franka_sim
