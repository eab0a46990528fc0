// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "effort_controllers/joint_group_position_controller.h"

#include <forward_command_controller/detail/joint_group.h>
#include <pluginlib/class_list_macros.h>

namespace effort_controllers {

namespace detail = forward_command_controller::detail;

JointGroupPositionController::~JointGroupPositionController() { sub_command_.shutdown(); }

bool JointGroupPositionController::init(hardware_interface::EffortJointInterface* hw,
                                        ros::NodeHandle& n) {
  if (!detail::readJointNames(n, joint_names_)) {
    return false;
  }
  n_joints_ = static_cast<unsigned int>(joint_names_.size());
  // All at once: a Pid with dynamic reconfigure must not be moved.
  pid_controllers_.resize(joint_names_.size());
  for (const std::string& name : joint_names_) {
    if (!addJoint(name, hw, n)) {
      return false;
    }
  }
  detail::prepareBuffer(joint_names_.size(), commands_buffer_);
  sub_command_ = n.subscribe<std_msgs::Float64MultiArray>(
      "command", 1, &JointGroupPositionController::commandCB, this);
  return true;
}

bool JointGroupPositionController::addJoint(const std::string& name,
                                            hardware_interface::EffortJointInterface* hw,
                                            const ros::NodeHandle& n) {
  urdf::JointConstSharedPtr joint;
  if (!detail::findJoint(n, name, joint) ||
      !pid_controllers_[joints_.size()].init(ros::NodeHandle(n, name + "/pid"))) {
    return false;
  }
  joints_.push_back(hw->getHandle(name));
  joint_urdfs_.push_back(joint);
  ranges_.emplace_back(*joint);
  return true;
}

void JointGroupPositionController::starting(const ros::Time& /*time*/) {
  // Written through the real-time pointer: allocates nothing, and drops older commands.
  std::vector<double>& commands = *commands_buffer_.readFromRT();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    commands[i] = ranges_[i].clamped(joints_[i].getPosition());
    pid_controllers_[i].reset();
  }
}

void JointGroupPositionController::update(const ros::Time& /*time*/, const ros::Duration& period) {
  const std::vector<double>& commands = *commands_buffer_.readFromRT();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double error = ranges_[i].way(joints_[i].getPosition(), ranges_[i].clamped(commands[i]));
    joints_[i].setCommand(pid_controllers_[i].computeCommand(error, period));
  }
}

void JointGroupPositionController::stopping(const ros::Time& /*time*/) {
  for (hardware_interface::JointHandle& joint : joints_) {
    joint.setCommand(0.0);
  }
}

void JointGroupPositionController::commandCB(const std_msgs::Float64MultiArrayConstPtr& msg) {
  detail::acceptCommands(msg->data, joint_names_, commands_buffer_);
}

}  // namespace effort_controllers

PLUGINLIB_EXPORT_CLASS(effort_controllers::JointGroupPositionController,
                       controller_interface::ControllerBase)
