// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/vacuum_gripper_state.h>

#include "json.h"

namespace franka {

namespace {

const char* nameOf(VacuumGripperDeviceStatus status) {
  switch (status) {
    case VacuumGripperDeviceStatus::kGreen:
      return "Green";
    case VacuumGripperDeviceStatus::kYellow:
      return "Yellow";
    case VacuumGripperDeviceStatus::kOrange:
      return "Orange";
    case VacuumGripperDeviceStatus::kRed:
      return "Red";
  }
  return "Unknown";
}

const char* toJson(bool value) { return value ? "true" : "false"; }

}  // namespace

std::ostream& operator<<(std::ostream& ostream, const VacuumGripperState& vacuum_gripper_state) {
  const VacuumGripperState& state = vacuum_gripper_state;
  ostream << "{\"in_control_range\": " << toJson(state.in_control_range);
  ostream << ", \"part_detached\": " << toJson(state.part_detached);
  ostream << ", \"part_present\": " << toJson(state.part_present);
  ostream << ", \"device_status\": \"" << nameOf(state.device_status) << "\"";
  ostream << ", \"actual_power\": " << state.actual_power;
  ostream << ", \"vacuum\": " << state.vacuum;
  writeMember(ostream, "time", state.time.toSec());
  return ostream << "}";
}

}  // namespace franka
