// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Publishes the joint states of a hand; sends it no commands.
#include <franka/exception.h>
#include <franka/gripper.h>
#include <franka_hw/usage.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/rate.h>
#include <sensor_msgs/JointState.h>

#include "parameters.h"

namespace {

constexpr char kUsage[] =
    "usage: rosrun franka_visualization gripper_joint_state_publisher [NAME:=VALUE]...\n\n"
    "Publishes a hand's ~joint_states (sensor_msgs/JointState); sends no commands. Parameters:\n"
    "~robot_ip, ~joint_names (two), ~publish_rate [Hz]. franka_visualization.launch sets them.";

}  // namespace

int main(int argc, char** argv) {
  if (franka_hw::printsUsage(argc, argv, kUsage)) {
    return 0;
  }
  ros::init(argc, argv, "gripper_joint_state_publisher");
  ros::NodeHandle nh("~");
  try {
    const auto parameters = franka_visualization::readParameters(nh, 2);
    const franka::Gripper gripper(parameters.robot_ip);
    franka_visualization::describedBy(nh, parameters);
    ros::Publisher publisher = nh.advertise<sensor_msgs::JointState>("joint_states", 1);
    sensor_msgs::JointState message;
    message.name = parameters.joint_names;
    message.velocity.assign(2, 0.0);
    message.effort.assign(2, 0.0);
    ros::Rate rate(parameters.publish_rate);
    while (ros::ok()) {
      const franka::GripperState state = gripper.readOnce();
      message.header.stamp = ros::Time::now();
      message.position.assign(2, 0.5 * state.width);
      publisher.publish(message);
      rate.sleep();
    }
  } catch (const franka::NetworkException& error) {
    ROS_ERROR_STREAM("gripper_joint_state_publisher: " << error.what()
                                                       << franka_visualization::kNoRobot);
    return -1;
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("gripper_joint_state_publisher: " << error.what());
    return -1;
  }
  return 0;
}
