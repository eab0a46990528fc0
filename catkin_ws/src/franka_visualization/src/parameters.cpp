// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "parameters.h"

#include <ros/console.h>

#include <cmath>
#include <stdexcept>

namespace franka_visualization {

namespace {

template <typename T>
void require(const ros::NodeHandle& nh, const std::string& name, const char* what, T& value) {
  if (!nh.getParam(name, value)) {
    throw std::invalid_argument("The parameter '" + nh.resolveName(name) +
                                "' is missing or is not " + what + ".");
  }
}

}  // namespace

const char* const kNoRobot =
    " Without a robot, start a simulated one: `franka_sim --robot panda --ip 127.0.0.1` (or fr3, "
    "any loopback address).";

Parameters readParameters(const ros::NodeHandle& nh, std::size_t joints) {
  Parameters parameters;
  require(nh, "joint_names", "a list of names", parameters.joint_names);
  require(nh, "robot_ip", "a string (the robot's address)", parameters.robot_ip);
  require(nh, "publish_rate", "a number [Hz]", parameters.publish_rate);
  if (parameters.joint_names.size() != joints) {
    throw std::invalid_argument("The parameter '" + nh.resolveName("joint_names") + "' must hold " +
                                std::to_string(joints) + " names, not " +
                                std::to_string(parameters.joint_names.size()) + ".");
  }
  if (!std::isfinite(parameters.publish_rate) || parameters.publish_rate <= 0.0) {
    throw std::invalid_argument("The parameter '" + nh.resolveName("publish_rate") +
                                "' must be above zero.");
  }
  return parameters;
}

std::optional<urdf::Model> describedBy(const ros::NodeHandle& nh, const Parameters& parameters) {
  std::string name;
  urdf::Model description;
  if (!nh.searchParam("robot_description", name) || !description.initParam(name)) {
    return std::nullopt;
  }
  for (const std::string& joint : parameters.joint_names) {
    if (!description.getJoint(joint)) {
      ROS_WARN_STREAM("The parameter '" << nh.resolveName("joint_names") << "' holds '" << joint
                                        << "', which is not a joint of '" << name
                                        << "': give both the same arm_id.");
      return std::nullopt;
    }
  }
  return description;
}

}  // namespace franka_visualization
