// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>

namespace franka_sim {

/// The events that can change the robot's mode.
enum class ModeEvent {
  kMotionStarted,
  kMotionEnded,
  kError,  ///< a check has failed
  kRecoveryStarted,
  kRecoveryEnded,
  kRecoveryFailed,
  kGuidingStarted,
  kGuidingEnded,
  kUserStopPressed,
  kUserStopReleased,
  kBrakesClosed,
  kBrakesOpened,
};
constexpr int kModeEventCount = 12;

/// The robot's mode and the table of its transitions (protocol 5.1). An event without a transition
/// from the present mode changes nothing. Called by one thread. Real-time safe.
class ModeMachine {
 public:
  franka_core::RobotMode mode() const noexcept { return mode_; }

  /// @returns whether the event caused a transition.
  bool handle(ModeEvent event) noexcept;

  /// Whether the brakes close in this mode, once the arm rests.
  bool closesBrakes() const noexcept;

 private:
  franka_core::RobotMode mode_{franka_core::RobotMode::kIdle};
};

}  // namespace franka_sim
