// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "position_controllers/joint_position_controller.h"

#include <pluginlib/class_list_macros.h>

template <>
void position_controllers::JointPositionController::starting(const ros::Time& /*time*/) {
  command_buffer_.initRT(joint_.getPosition());
}

PLUGINLIB_EXPORT_CLASS(position_controllers::JointPositionController,
                       controller_interface::ControllerBase)
