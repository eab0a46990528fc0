// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <forward_command_controller/forward_joint_group_command_controller.h>

namespace velocity_controllers {

/// Forwards velocities from the topic `command` to several joints; see
/// ForwardJointGroupCommandController. Starts with zero.
typedef forward_command_controller::ForwardJointGroupCommandController<
    hardware_interface::VelocityJointInterface>
    JointGroupVelocityController;

}  // namespace velocity_controllers

namespace forward_command_controller {

template <>
void ForwardJointGroupCommandController<hardware_interface::VelocityJointInterface>::starting(
    const ros::Time& time);

}  // namespace forward_command_controller
