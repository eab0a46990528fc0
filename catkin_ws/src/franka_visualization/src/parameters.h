// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <urdf/model.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace franka_visualization {

/// What both nodes are told.
struct Parameters {
  std::vector<std::string> joint_names;
  std::string robot_ip;
  double publish_rate{0.0};  ///< [Hz]
};

/// Reads them from the node's namespace. @param joints how many names there must be
/// @throws std::invalid_argument with a sentence that names the parameter
Parameters readParameters(const ros::NodeHandle& nh, std::size_t joints);

/// Warns in one sentence of joints that robot_description does not hold: what shows the robot would
/// wait for them for ever. @returns the description; nothing where there is none, or no such joint
std::optional<urdf::Model> describedBy(const ros::NodeHandle& nh, const Parameters& parameters);

/// What to do where no robot answers, to go after libfranka's sentence.
extern const char* const kNoRobot;

}  // namespace franka_visualization
