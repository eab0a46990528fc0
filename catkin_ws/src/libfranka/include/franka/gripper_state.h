// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>

#include <cstdint>
#include <ostream>

/// @file
/// The state of the hand.

namespace franka {

/// One state of the Franka hand.
struct GripperState {
  double width{};          ///< opening between the fingers [m]
  double max_width{};      ///< largest opening, found by homing [m]
  bool is_grasped{};       ///< an object is held
  uint16_t temperature{};  ///< of the motor [deg C]
  Duration time{};         ///< clock of the hand
};

/// Writes the state as one JSON object; `time` in [s].
std::ostream& operator<<(std::ostream& ostream, const GripperState& gripper_state);

}  // namespace franka
