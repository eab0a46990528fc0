// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "velocity_controllers/joint_velocity_controller.h"

#include <pluginlib/class_list_macros.h>

template <>
void velocity_controllers::JointVelocityController::starting(const ros::Time& /*time*/) {
  command_buffer_.initRT(0.0);
}

PLUGINLIB_EXPORT_CLASS(velocity_controllers::JointVelocityController,
                       controller_interface::ControllerBase)
