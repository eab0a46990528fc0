// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>

namespace franka_sim {

/// The low-pass filters that clients up to protocol 5 can set for motion generators and torque
/// controller (SetFilters). First order (protocol 5.6); at 1000 Hz a signal passes unchanged.
/// Rotations are filtered along the shortest arc. Called by one thread. Real-time safe.
class CommandFilter {
 public:
  /// @returns whether all cutoffs are within 1 and 1000 Hz.
  bool set(const franka_core::fci::SetFiltersRequest& cutoffs) noexcept;
  /// Starts at q_d, O_T_EE_c and elbow_c of the state, at rest.
  void begin(const franka_core::RobotState& state) noexcept;
  /// Filters one command. Values that are not finite or no rigid transform pass unchanged, to be
  /// refused later.
  const franka_core::RobotCommand& apply(const franka_core::RobotCommand& command) noexcept;

 private:
  franka_core::fci::SetFiltersRequest cutoffs_;
  bool active_{false};
  franka_core::RobotCommand last_;
};

}  // namespace franka_sim
