// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>

#include <cstdint>
#include <ostream>

/// @file
/// The state of the vacuum gripper (cobot pump).

namespace franka {

/// Health of the pump.
enum class VacuumGripperDeviceStatus : uint8_t {
  kGreen,   ///< works
  kYellow,  ///< works with warnings
  kOrange,  ///< works with severe warnings
  kRed      ///< does not work
};

/// One state of the vacuum gripper.
struct VacuumGripperState {
  bool in_control_range{};                    ///< vacuum within the set range
  bool part_detached{};                       ///< the part was released by a command
  bool part_present{};                        ///< the vacuum shows that a part is held
  VacuumGripperDeviceStatus device_status{};  ///< health of the pump
  uint16_t actual_power{};                    ///< power of the pump [%]
  uint16_t vacuum{};                          ///< vacuum [mbar]
  Duration time{};                            ///< clock of the gripper
};

/// Writes the state as one JSON object; `time` in [s].
std::ostream& operator<<(std::ostream& ostream, const VacuumGripperState& vacuum_gripper_state);

}  // namespace franka
