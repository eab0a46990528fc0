// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "effort_controllers/joint_group_effort_controller.h"

#include <pluginlib/class_list_macros.h>

template <>
void effort_controllers::JointGroupEffortController::starting(const ros::Time& /*time*/) {
  // Written through the real-time pointer: allocates nothing, and drops older commands.
  std::vector<double>& commands = *commands_buffer_.readFromRT();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    commands[i] = 0.0;
  }
}

PLUGINLIB_EXPORT_CLASS(effort_controllers::JointGroupEffortController,
                       controller_interface::ControllerBase)
