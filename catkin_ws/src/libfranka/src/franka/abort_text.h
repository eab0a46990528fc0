// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>

#include <cstdint>
#include <string>
#include <vector>

#include "franka/motion_log.h"

namespace franka {

/// The text about a motion that ended by reflex: the genuine client's text word for word
/// (protocol 3.4), followed by separate lines with the cause found in the log.
/// @param text the event. @param state the newest one, with its reflex_reason.
/// @param log the last states and commands, oldest first. @param version the robot's protocol.
std::string reflexText(const std::string& text, const franka_core::RobotState& state,
                       const std::vector<MotionLog::Entry>& log, std::uint16_t version);

}  // namespace franka
