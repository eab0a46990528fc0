// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_interface/controller_base.h>
// Tests the header's ROS 1 name, used in users' controllers.
#include <pluginlib/class_list_macros.h>

#include "../dummies.h"

namespace controller_manager_test {

class PluginController : public dummies::DummyController {};

}  // namespace controller_manager_test

PLUGINLIB_EXPORT_CLASS(controller_manager_test::PluginController,
                       controller_interface::ControllerBase)
