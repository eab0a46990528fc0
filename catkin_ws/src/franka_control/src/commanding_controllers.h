// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

namespace franka_control {

/// Stops the running controllers that command anything; those that only look go on. By the services
/// of the controller manager, which wait for the control loop: not for its thread.
/// @param nh of the manager
/// @returns false after a sentence when they could not be stopped
bool stopCommandingControllers(const ros::NodeHandle& nh);

}  // namespace franka_control
