// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper_state.h>

#include "json.h"

namespace franka {

std::ostream& operator<<(std::ostream& ostream, const GripperState& gripper_state) {
  ostream << "{\"width\": ";
  writeJson(ostream, gripper_state.width);
  writeMember(ostream, "max_width", gripper_state.max_width);
  ostream << ", \"is_grasped\": " << (gripper_state.is_grasped ? "true" : "false");
  ostream << ", \"temperature\": " << gripper_state.temperature;
  writeMember(ostream, "time", gripper_state.time.toSec());
  return ostream << "}";
}

}  // namespace franka
