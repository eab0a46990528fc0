// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Publishes the joint states of an arm; sends it no commands. The robot accepts one connection at a
// time: this cannot run together with franka_control_node.
#include <franka/exception.h>
#include <franka/robot.h>
#include <franka_hw/resource_helpers.h>
#include <franka_hw/robot_mismatch.h>
#include <franka_hw/usage.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/rate.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <array>
#include <string>

#include "parameters.h"

namespace {

constexpr char kUsage[] =
    "usage: rosrun franka_visualization robot_joint_state_publisher [NAME:=VALUE]...\n\n"
    "Publishes an arm's ~joint_states (sensor_msgs/JointState); sends no commands. Parameters:\n"
    "~robot_ip, ~joint_names (seven), ~publish_rate [Hz]. franka_visualization.launch sets them.";

/// Warns if the robot does not match robot_description.
void compare(const ros::NodeHandle& nh, const franka_visualization::Parameters& parameters,
             unsigned protocol) {
  std::array<std::string, 7> joint_names;
  std::copy_n(parameters.joint_names.begin(), joint_names.size(), joint_names.begin());
  std::string arm_id;
  const auto description = franka_visualization::describedBy(nh, parameters);
  if (!description || !franka_hw::findArmIdInResourceId(joint_names[0], &arm_id)) {
    return;
  }
  const std::string what = franka_hw::robotMismatch(*description, arm_id, joint_names, protocol);
  if (!what.empty()) {
    ROS_WARN_STREAM("robot_joint_state_publisher: " << what);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (franka_hw::printsUsage(argc, argv, kUsage)) {
    return 0;
  }
  ros::init(argc, argv, "robot_joint_state_publisher");
  ros::NodeHandle nh("~");
  try {
    const auto parameters = franka_visualization::readParameters(nh, 7);
    // Reading states needs no real-time priority.
    franka::Robot robot(parameters.robot_ip, franka::RealtimeConfig::kIgnore);
    compare(nh, parameters, robot.serverVersion());
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
  } catch (const franka::NetworkException& error) {
    ROS_ERROR_STREAM("robot_joint_state_publisher: " << error.what()
                                                     << franka_visualization::kNoRobot);
    return -1;
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("robot_joint_state_publisher: " << error.what());
    return -1;
  }
  return 0;
}
