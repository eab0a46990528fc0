// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/abort_text.h"

#include <franka/errors.h>

#include <sstream>

namespace franka {

std::string reflexText(const std::string& text, const franka_core::RobotState& state,
                       const std::vector<MotionLog::Entry>& log, std::uint16_t version) {
  std::ostringstream message;
  message << text << " " << Errors(state.reflex_reason);
  if (log.size() >= 2) {
    // The last state shows the abort; its own rate is 0.
    const franka_core::RobotState& before = log[log.size() - 2].state;
    const std::uint64_t lost = log.back().state.message_id - before.message_id - 1;
    message << "\ncontrol_command_success_rate: "
            << before.control_command_success_rate * (1.0 - static_cast<double>(lost) / 100.0);
    if (lost > 0) {
      message << " packets lost in a row in the last sample: " << lost;
    }
  }
  for (const std::string& sentence : franka_core::diagnoseAbort(log, version)) {
    message << "\n" << sentence;
  }
  return message.str();
}

}  // namespace franka
