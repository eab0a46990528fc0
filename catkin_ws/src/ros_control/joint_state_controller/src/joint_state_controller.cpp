// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "joint_state_controller/joint_state_controller.h"

#include <pluginlib/class_list_macros.h>
#include <ros/console.h>

#include <cmath>

#include "extra_joints.h"

namespace joint_state_controller {

namespace {

constexpr int kQueueSize = 4;  // as in the original

/// Tolerance for sums of periods that are not exact in binary [s].
constexpr double kRounding = 1e-6;

}  // namespace

bool JointStateController::init(hardware_interface::JointStateInterface* hw,
                                ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh) {
  std::vector<std::string> names;
  if (controller_nh.hasParam("joints")) {
    if (!controller_nh.getParam("joints", names)) {
      ROS_ERROR("The parameter 'joints' (namespace: %s) is not a list of joint names.",
                controller_nh.getNamespace().c_str());
      return false;
    }
  } else {
    names = hw->getNames();
  }
  double publish_rate = 0.0;
  if (!controller_nh.getParam("publish_rate", publish_rate)) {
    ROS_ERROR("Parameter 'publish_rate' not set");
    return false;
  }
  period_ = std::isfinite(publish_rate) && publish_rate > 0.0 ? 1.0 / publish_rate : 0.0;

  for (const std::string& name : names) {
    joint_state_.push_back(hw->getHandle(name));
  }
  realtime_pub_ = std::make_unique<Publisher>(root_nh, "joint_states", kQueueSize);
  sensor_msgs::JointState message;
  message.name = names;
  message.position.resize(names.size());
  message.velocity.resize(names.size());
  message.effort.resize(names.size());
  addExtraJoints(controller_nh, message);
  realtime_pub_->lock();
  realtime_pub_->msg_ = message;
  realtime_pub_->unlock();
  return true;
}

void JointStateController::starting(const ros::Time& time) { next_ = time.toSec(); }

void JointStateController::update(const ros::Time& time, const ros::Duration& /*period*/) {
  if (!isDue(time) || !realtime_pub_->trylock()) {
    return;
  }
  const double now = time.toSec();
  next_ += period_;
  if (next_ <= now) {
    next_ = now + period_;
  }
  sensor_msgs::JointState& message = realtime_pub_->msg_;
  message.header.stamp = time;
  for (std::size_t i = 0; i < joint_state_.size(); ++i) {
    message.position[i] = joint_state_[i].getPosition();
    message.velocity[i] = joint_state_[i].getVelocity();
    message.effort[i] = joint_state_[i].getEffort();
  }
  realtime_pub_->unlockAndPublish();
}

void JointStateController::stopping(const ros::Time& /*time*/) {}

bool JointStateController::isDue(const ros::Time& time) {
  if (period_ == 0.0) {
    return false;
  }
  const double now = time.toSec();
  if (next_ - now > period_ + kRounding) {
    next_ = now;  // time jumped back
  }
  return now >= next_ - kRounding;
}

}  // namespace joint_state_controller

PLUGINLIB_EXPORT_CLASS(joint_state_controller::JointStateController,
                       controller_interface::ControllerBase)
