// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "effort_controllers/joint_velocity_controller.h"

#include <pluginlib/class_list_macros.h>
#include <ros/console.h>

#include <cmath>

namespace effort_controllers {

JointVelocityController::~JointVelocityController() { sub_command_.shutdown(); }

bool JointVelocityController::init(hardware_interface::EffortJointInterface* robot,
                                   ros::NodeHandle& n) {
  if (!initJoint(robot, n)) {
    return false;
  }
  sub_command_ =
      n.subscribe<std_msgs::Float64>("command", 1, &JointVelocityController::commandCB, this);
  return true;
}

void JointVelocityController::setCommand(double cmd) {
  if (!std::isfinite(cmd)) {
    ROS_ERROR_STREAM_THROTTLE(
        1.0, "The command for joint '"
                 << joint_.getName() << "' is " << cmd
                 << ", which is not a finite number. Not executing; the last command stays.");
    return;
  }
  command_.writeFromNonRT(cmd);
}

void JointVelocityController::getCommand(double& cmd) { cmd = *command_.readFromNonRT(); }

void JointVelocityController::starting(const ros::Time& /*time*/) {
  command_.initRT(0.0);
  loop_.start();
}

void JointVelocityController::update(const ros::Time& time, const ros::Duration& period) {
  const double target = *command_.readFromRT();
  const double velocity = joint_.getVelocity();
  const double error = target - velocity;
  joint_.setCommand(loop_.command(error, period));
  loop_.publish(time, period, target, velocity, error, joint_);
}

void JointVelocityController::stopping(const ros::Time& /*time*/) { joint_.setCommand(0.0); }

void JointVelocityController::commandCB(const std_msgs::Float64ConstPtr& msg) {
  setCommand(msg->data);
}

}  // namespace effort_controllers

PLUGINLIB_EXPORT_CLASS(effort_controllers::JointVelocityController,
                       controller_interface::ControllerBase)
