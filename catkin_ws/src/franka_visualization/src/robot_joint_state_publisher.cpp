// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Publishes the joint states of an arm, and only looks at it. The robot accepts one connection at a
// time: this cannot run beside franka_control_node.
#include <franka/exception.h>
#include <franka/robot.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/rate.h>
#include <sensor_msgs/JointState.h>

#include "parameters.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "robot_joint_state_publisher");
  ros::NodeHandle nh("~");
  try {
    const auto parameters = franka_visualization::readParameters(nh, 7);
    // Who only looks needs no real-time priority.
    franka::Robot robot(parameters.robot_ip, franka::RealtimeConfig::kIgnore);
    ros::Publisher publisher = nh.advertise<sensor_msgs::JointState>("joint_states", 1);
    sensor_msgs::JointState message;
    message.name = parameters.joint_names;
    ros::Rate rate(parameters.publish_rate);
    robot.read([&](const franka::RobotState& state) {
      message.header.stamp = ros::Time::now();
      message.position.assign(state.q.begin(), state.q.end());
      message.velocity.assign(state.dq.begin(), state.dq.end());
      message.effort.assign(state.tau_J.begin(), state.tau_J.end());
      publisher.publish(message);
      rate.sleep();
      return ros::ok();
    });
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("robot_joint_state_publisher: " << error.what());
    return -1;
  }
  return 0;
}
