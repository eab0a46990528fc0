// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <forward_command_controller/forward_command_controller.h>

namespace effort_controllers {

/// Forwards an effort from the topic `command` to one joint; see ForwardCommandController. Starts
/// with zero.
typedef forward_command_controller::ForwardCommandController<
    hardware_interface::EffortJointInterface>
    JointEffortController;

}  // namespace effort_controllers

namespace forward_command_controller {

template <>
void ForwardCommandController<hardware_interface::EffortJointInterface>::starting(
    const ros::Time& time);

}  // namespace forward_command_controller
