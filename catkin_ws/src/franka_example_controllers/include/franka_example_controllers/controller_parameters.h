// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace franka_example_controllers {

/// Reads the name of the arm from `arm_id` in a controller's namespace.
/// @param controller class name, for the sentence in the log
/// @returns false if it is missing, empty or not a string
bool readArmId(const char* controller, const ros::NodeHandle& node_handle, std::string& arm_id);

/// Reads the arm's seven joint names from `joint_names` in a controller's namespace.
/// @returns false, after one sentence in the log, unless there are seven
bool readJointNames(const char* controller, const ros::NodeHandle& node_handle,
                    std::vector<std::string>& joint_names);

/// Reads seven numbers, one per joint, from a parameter in a controller's namespace.
/// @returns false, after one sentence in the log, unless there are seven finite ones
bool readGains(const char* controller, const ros::NodeHandle& node_handle, const std::string& name,
               std::vector<double>& gains);

}  // namespace franka_example_controllers
