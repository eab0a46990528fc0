// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "position_controllers/joint_group_position_controller.h"

#include <pluginlib/class_list_macros.h>

template <>
void position_controllers::JointGroupPositionController::starting(const ros::Time& /*time*/) {
  // Written through the real-time pointer: allocates nothing, and drops older commands.
  std::vector<double>& commands = *commands_buffer_.readFromRT();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    commands[i] = joints_[i].getPosition();
  }
}

PLUGINLIB_EXPORT_CLASS(position_controllers::JointGroupPositionController,
                       controller_interface::ControllerBase)
