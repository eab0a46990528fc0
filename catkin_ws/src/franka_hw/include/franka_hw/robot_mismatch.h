// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf/model.h>

#include <array>
#include <string>

namespace franka_hw {

/// In what the parameters of an arm contradict each other, its description or the robot that
/// answers. Pure. Not real-time safe.
///
/// Checked are: joints that are not named after the arm (controllers would command another one),
/// joints that the description does not hold, and a description that lets a joint move where the
/// robot's cannot: a Panda's for an FR3, or the reverse. Narrower ranges are no contradiction.
/// @param description what robot_description holds
/// @param protocol the version that the robot speaks: up to 5 a Panda, from 6 on an FR3
/// @returns one sentence, or several of one line, without "FrankaHW:"; empty where all agree
std::string robotMismatch(const urdf::Model& description, const std::string& arm_id,
                          const std::array<std::string, 7>& joint_names, unsigned protocol);

}  // namespace franka_hw
