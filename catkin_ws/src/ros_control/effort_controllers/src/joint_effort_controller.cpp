// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "effort_controllers/joint_effort_controller.h"

#include <pluginlib/class_list_macros.h>

template <>
void effort_controllers::JointEffortController::starting(const ros::Time& /*time*/) {
  command_buffer_.initRT(0.0);
}

PLUGINLIB_EXPORT_CLASS(effort_controllers::JointEffortController,
                       controller_interface::ControllerBase)
