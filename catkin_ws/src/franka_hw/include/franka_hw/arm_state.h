// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace franka_hw {

/// The state of the connection to one arm.
enum class ArmState {
  kDisconnected,  ///< not connected yet, or given up by the user
  kIdle,          ///< connected; no motion holds the robot
  kMoving,        ///< a motion holds the robot
  kBraking,       ///< an error ends the motion, which still holds the robot
  kStopped,       ///< the robot has stopped with an error of its own
  kError,         ///< a controller or the connection had an error
  kLost,          ///< the connection broke
  kLostInError,   ///< as kLost; a recovery has to follow when the connection is back
};
constexpr int kArmStateCount = 8;  ///< members of ArmState

/// Events that can change the state.
enum class ArmEvent {
  kConnected,
  kGivenUp,  ///< the user disconnects
  kLost,     ///< the robot does not answer any more
  kMotionStarted,
  kMotionEnded,
  kRobotStopped,        ///< a reflex, or another abort by the robot
  kFailed,              ///< an error that is not the robot's
  kRecovered,           ///< by a recovery of ArmConnection
  kRecoveredElsewhere,  ///< the robot is Idle again by other means: its user stop was released
};
constexpr int kArmEventCount = 9;  ///< members of ArmEvent

/// @name Groups of states. Real-time safe. Thread-safe.
/// @{
bool isConnected(ArmState state) noexcept;
/// A motion holds the robot.
bool isInMotion(ArmState state) noexcept;
/// The robot needs a recovery.
bool isInError(ArmState state) noexcept;
/// The robot was lost; `connect` or `reconnect` ends it.
bool isLost(ArmState state) noexcept;
/// @}

/// The state of the connection to one arm. The table of its transitions: arm_state.cpp. An event
/// without a transition from the present state changes nothing. Real-time safe. Thread-safe.
class ArmStateMachine {
 public:
  explicit ArmStateMachine(ArmState state = ArmState::kDisconnected) noexcept : state_(state) {}

  /// The present state.
  ArmState state() const noexcept { return state_; }

  /// @returns whether the event caused a transition
  bool handle(ArmEvent event) noexcept;

 private:
  std::atomic<ArmState> state_;
};

}  // namespace franka_hw
