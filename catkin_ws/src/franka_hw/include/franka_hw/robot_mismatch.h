// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf/model.h>

#include <array>
#include <string>

namespace franka_hw {

/// Checks whether the parameters of an arm contradict each other, its description or the connected
/// robot. No side effects. Not real-time safe.
///
/// The checks: joints that are not named after the arm (controllers would command another one),
/// joints that are missing in the description, and a description that lets a joint move where the
/// robot's cannot: a Panda's for an FR3, or the reverse. Narrower ranges are accepted.
/// @param description the content of robot_description
/// @param protocol the protocol version of the robot: up to 5 a Panda, from 6 on an FR3
/// @returns one line of one or more sentences, without "FrankaHW:"; empty if there is no
/// contradiction
std::string robotMismatch(const urdf::Model& description, const std::string& arm_id,
                          const std::array<std::string, 7>& joint_names, unsigned protocol);

}  // namespace franka_hw
