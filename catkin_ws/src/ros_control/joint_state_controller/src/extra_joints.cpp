// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "extra_joints.h"

#include <ros/console.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <algorithm>
#include <string>

namespace joint_state_controller {

namespace {

using XmlRpc::XmlRpcValue;

/// A number of the entry, 0 if missing. @return false, after logging, if it is not a number.
bool readNumber(XmlRpcValue& entry, const char* key, const std::string& joint, double& number) {
  number = 0.0;
  if (!entry.hasMember(key)) {
    return true;
  }
  XmlRpcValue& value = entry[key];
  if (value.getType() == XmlRpcValue::TypeDouble) {
    number = static_cast<double>(value);
    return true;
  }
  if (value.getType() == XmlRpcValue::TypeInt) {
    number = static_cast<int>(value);
    return true;
  }
  ROS_ERROR("The extra joint '%s' is skipped: its %s is not a number.", joint.c_str(), key);
  return false;
}

void addExtraJoint(XmlRpcValue& entry, sensor_msgs::JointState& message) {
  if (entry.getType() != XmlRpcValue::TypeStruct || !entry.hasMember("name") ||
      entry["name"].getType() != XmlRpcValue::TypeString) {
    ROS_ERROR(
        "An entry of extra_joints is skipped: each must be a map with the string 'name', and "
        "'position', 'velocity' and 'effort' if needed.");
    return;
  }
  const std::string name = entry["name"];
  if (std::find(message.name.begin(), message.name.end(), name) != message.name.end()) {
    ROS_ERROR("The extra joint '%s' is skipped: its state is published already.", name.c_str());
    return;
  }
  double position;
  double velocity;
  double effort;
  if (!readNumber(entry, "position", name, position) ||
      !readNumber(entry, "velocity", name, velocity) ||
      !readNumber(entry, "effort", name, effort)) {
    return;
  }
  message.name.push_back(name);
  message.position.push_back(position);
  message.velocity.push_back(velocity);
  message.effort.push_back(effort);
}

}  // namespace

void addExtraJoints(const ros::NodeHandle& node, sensor_msgs::JointState& message) {
  XmlRpcValue list;
  if (!node.getParam("extra_joints", list)) {
    return;
  }
  if (list.getType() != XmlRpcValue::TypeArray) {
    ROS_ERROR("The parameter 'extra_joints' (namespace: %s) is not a list: no extra joints.",
              node.getNamespace().c_str());
    return;
  }
  for (int i = 0; i < list.size(); ++i) {
    addExtraJoint(list[i], message);
  }
}

}  // namespace joint_state_controller
