// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>

#include <string>
#include <vector>

namespace franka_core {

/// A state, and the command that had been sent just before it arrived.
struct AbortRecord {
  RobotState state;      ///< that the client received
  RobotCommand command;  ///< that answered it
  /// How long the client took for that command, from the arrival of the state that it answered [s];
  /// 0: unknown.
  double answer_time{0.0};
};

/// Explains to the user why a motion was aborted: for each flag of the last state's reflex_reason
/// the joint or axis that caused it, and the value against the limit, as far as the logged states
/// and commands show it.
///
/// Velocities, accelerations, jerks and torque rates are those the robot computes (backward Euler
/// over 1 ms, from the state the command answered). A pure function. Not real-time safe.
/// @param log oldest first, as kept by the client
/// @param version of the robot's protocol, which selects the limits
/// @returns one sentence per flag; none for an empty log
std::vector<std::string> diagnoseAbort(const std::vector<AbortRecord>& log, unsigned version);

/// The number of states that did not arrive before the last one of the log.
std::uint64_t statesLost(const std::vector<AbortRecord>& log) noexcept;

}  // namespace franka_core
