// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/robot_error.h>
#include <franka_sim/robot/errors.h>

namespace franka_sim {

std::string conditionText(const std::string& name, const franka_core::RobotState& state) {
  std::string text = name + ": " + franka_core::fci::modeName(state.robot_mode);
  for (std::size_t i = 0; i < franka_core::kErrorCount; i++) {
    if (state.errors[i]) {
      text += ", " + std::string(franka_core::kErrorNames[i]);
    }
  }
  return text;
}

}  // namespace franka_sim
