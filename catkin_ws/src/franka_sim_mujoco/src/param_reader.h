// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Numbers of a parameter given as a YAML list or as a string "1 2 3"; empty if it is not set,
/// as with a name that ROS cannot have.
/// @param count required number of values
/// @throws std::invalid_argument naming the parameter, its value and the expected form
std::optional<std::vector<double>> readNumbers(const ros::NodeHandle& node, const std::string& name,
                                               std::size_t count);

/// A single number; same rules.
std::optional<double> readNumber(const ros::NodeHandle& node, const std::string& name);

/// A text or a boolean of exactly that type.
std::optional<std::string> readString(const ros::NodeHandle& node, const std::string& name);
std::optional<bool> readBool(const ros::NodeHandle& node, const std::string& name);

/// Replaces `value` by the parameter if it is set.
template <std::size_t N>
void readArray(const ros::NodeHandle& node, const std::string& name, std::array<double, N>& value) {
  if (const auto numbers = readNumbers(node, name, N)) {
    for (std::size_t i = 0; i < N; ++i) {
      value[i] = (*numbers)[i];
    }
  }
}

}  // namespace franka_sim_mujoco
