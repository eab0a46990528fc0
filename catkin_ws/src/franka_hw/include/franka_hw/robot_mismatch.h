// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <urdf/model.h>

#include <array>
#include <optional>
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

/// Compares the nominal end effector NE of an arm's control unit with the description's. If they
/// differ, the pose O_T_EE is not where TF has the tool. Not real-time safe.
/// @param described franka_core::nominalEndEffectorFromUrdf()
/// @returns two sentences with the difference and the description's F_T_NE; empty if the frames
/// agree within 0.1 mm and 1 mrad, or if the description has none
std::string endEffectorMismatch(const std::optional<std::array<double, 16>>& described,
                                const std::array<double, 16>& F_T_NE, const std::string& arm_id);

}  // namespace franka_hw
