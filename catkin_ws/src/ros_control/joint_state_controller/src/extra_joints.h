// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

namespace joint_state_controller {

/// Appends the joints of the parameter `extra_joints` to the message. An invalid entry is skipped
/// with an error in the log. Not real-time safe.
void addExtraJoints(const ros::NodeHandle& node, sensor_msgs::JointState& message);

}  // namespace joint_state_controller
