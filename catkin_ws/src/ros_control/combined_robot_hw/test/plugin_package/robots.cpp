// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "../test_robot.h"

// Tests the header's ROS 1 name, used in users' robots.
#include <pluginlib/class_list_macros.h>

PLUGINLIB_EXPORT_CLASS(combined_robot_hw_test::Robot, hardware_interface::RobotHW)
