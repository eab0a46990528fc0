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

/// Parameters of both nodes.
struct Parameters {
  std::vector<std::string> joint_names;
  std::string robot_ip;
  double publish_rate{0.0};  ///< [Hz]
};

/// Reads them from the node's namespace. @param joints how many names there must be
/// @throws std::invalid_argument with a message that names the parameter
Parameters readParameters(const ros::NodeHandle& nh, std::size_t joints);

/// Warns about joints that robot_description lacks, because programs that show the robot would wait
/// for them forever. @returns the description; empty if there is none or it lacks a joint
std::optional<urdf::Model> describedBy(const ros::NodeHandle& nh, const Parameters& parameters);

/// Advice if no robot answers, appended to libfranka's message.
extern const char* const kNoRobot;

}  // namespace franka_visualization
