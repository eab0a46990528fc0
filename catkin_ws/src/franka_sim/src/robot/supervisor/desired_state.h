// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>

#include <array>

#include "robot/motion/motion_generator.h"

namespace franka_sim {

/// The desired motion in the robot's state: q_d, O_T_EE_d, elbow_d and so on. Called by one thread.
/// Real-time safe.
class DesiredState {
 public:
  /// @param state outlives this.
  explicit DesiredState(franka_core::RobotState& state) noexcept : state_(&state) {}

  /// Sets the joints [rad, rad/s, rad/s^2]; the next update() computes the other fields.
  void set(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
           const std::array<double, 7>& ddq_d) noexcept;
  /// Sets all fields.
  void set(const DesiredMotion& desired) noexcept;
  /// Frames or loads have changed.
  void invalidate() noexcept { stale_ = true; }
  /// Computes the other fields again if the joints or frames have changed.
  void update(const franka_core::ArmModel& model) noexcept;

 private:
  FixedPointer<franka_core::RobotState> state_;
  bool stale_{true};
};

}  // namespace franka_sim
