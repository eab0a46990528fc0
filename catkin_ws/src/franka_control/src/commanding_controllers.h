// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

namespace franka_control {

/// Stops the running controllers that command anything; controllers that only read continue. Calls
/// the services of the controller manager, which wait for the control loop: must not be called by
/// its thread.
/// @param nh of the manager
/// @returns false, after logging the reason, if they could not be stopped
bool stopCommandingControllers(const ros::NodeHandle& nh);

}  // namespace franka_control
