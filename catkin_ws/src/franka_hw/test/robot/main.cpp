// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/extensions.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <chrono>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "franka_hw_robot_test");
  // A robot must not count as lost because the machine is busy with other work.
  franka::Timeouts patient;
  patient.state = std::chrono::seconds(30);
  franka::setTimeouts(patient);
  ros::NodeHandle keeps_ros_alive;
  ros::AsyncSpinner spinner(2);
  spinner.start();
  return RUN_ALL_TESTS();
}
