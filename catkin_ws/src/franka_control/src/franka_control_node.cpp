// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/usage.h>
#include <ros/init.h>
#include <ros/spinner.h>

#include "control_node.h"
#include "end_in_time.h"

namespace {

constexpr char kUsage[] =
    "usage: rosrun franka_control franka_control_node [NAME:=VALUE]...\n\n"
    "Drives one arm: its hardware interfaces, the controller manager, services and actions.\n"
    "Parameters: robot_ip, arm_id, joint_names and others in its own namespace, robot_description\n"
    "in the public one; docs/franka_control.md lists them. franka_control.launch sets them all:\n"
    "  roslaunch franka_control franka_control.launch robot_ip:=ADDRESS (or sim:=true)";

}  // namespace

int main(int argc, char** argv) {
  if (franka_hw::printsUsage(argc, argv, kUsage)) {
    return 0;
  }
  ros::init(argc, argv, "franka_control_node");
  franka_control::EndInTime end_in_time("franka_control_node");
  const ros::NodeHandle nh("~");
  franka_control::ControlNode node{ros::NodeHandle(), nh};
  if (!end_in_time.readTimeout(nh) || !node.init()) {
    return 1;
  }
  // Threads for services, actions and publishers; the main thread runs only the loop.
  ros::AsyncSpinner spinner(4);
  spinner.start();
  node.run();
  return 0;
}
