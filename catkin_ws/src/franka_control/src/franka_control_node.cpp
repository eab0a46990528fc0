// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/init.h>
#include <ros/spinner.h>

#include "control_node.h"
#include "end_in_time.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "franka_control_node");
  const franka_control::EndInTime end_in_time("franka_control_node");
  franka_control::ControlNode node{ros::NodeHandle(), ros::NodeHandle("~")};
  if (!node.init()) {
    return 1;
  }
  // Services, actions and publishers beside the loop, which has this thread for itself.
  ros::AsyncSpinner spinner(4);
  spinner.start();
  node.run();
  return 0;
}
