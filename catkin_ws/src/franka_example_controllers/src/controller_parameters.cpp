// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/controller_parameters.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>

namespace franka_example_controllers {

namespace {

constexpr std::size_t kJointCount = 7;

}  // namespace

bool readArmId(const char* controller, const ros::NodeHandle& node_handle, std::string& arm_id) {
  if (!node_handle.getParam("arm_id", arm_id) || arm_id.empty()) {
    ROS_ERROR("%s: set the parameter %s/arm_id to the name of the arm, such as 'panda'.",
              controller, node_handle.getNamespace().c_str());
    return false;
  }
  return true;
}

bool readJointNames(const char* controller, const ros::NodeHandle& node_handle,
                    std::vector<std::string>& joint_names) {
  joint_names.clear();
  if (!node_handle.getParam("joint_names", joint_names) || joint_names.size() != kJointCount) {
    ROS_ERROR(
        "%s: the parameter %s/joint_names must be a list of the arm's seven joint names; it has "
        "%zu.",
        controller, node_handle.getNamespace().c_str(), joint_names.size());
    return false;
  }
  return true;
}

bool readGains(const char* controller, const ros::NodeHandle& node_handle, const std::string& name,
               std::vector<double>& gains) {
  gains.clear();
  if (!node_handle.getParam(name, gains) || gains.size() != kJointCount ||
      !std::all_of(gains.begin(), gains.end(), [](double gain) { return std::isfinite(gain); })) {
    ROS_ERROR("%s: the parameter %s must be a list of seven numbers, one for each joint.",
              controller, node_handle.resolveName(name).c_str());
    return false;
  }
  return true;
}

}  // namespace franka_example_controllers
