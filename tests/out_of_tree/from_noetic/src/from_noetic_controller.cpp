// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_interface/multi_interface_controller.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <pluginlib/class_list_macros.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include <array>
#include <boost/bind.hpp>
#include <memory>
#include <string>
#include <vector>

namespace from_noetic {

/// Brakes the joints with a damping that a topic changes, and publishes the hand's height.
class FromNoeticController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaStateInterface, hardware_interface::EffortJointInterface> {
 public:
  bool init(hardware_interface::RobotHW* robot, ros::NodeHandle& node) override {
    std::string arm_id;
    if (!node.getParam("arm_id", arm_id) || !node.getParam("damping", damping_)) {
      ROS_ERROR("FromNoeticController: arm_id or damping is missing.");
      return false;
    }
    state_ = std::make_unique<franka_hw::FrankaStateHandle>(
        robot->get<franka_hw::FrankaStateInterface>()->getHandle(arm_id + "_robot"));
    auto* efforts = robot->get<hardware_interface::EffortJointInterface>();
    for (int joint = 1; joint <= 7; joint++) {
      joints_.push_back(efforts->getHandle(arm_id + "_joint" + std::to_string(joint)));
    }
    height_.init(node, "height", 1);
    subscriber_ = node.subscribe<std_msgs::Float64>(
        "damping", 1, boost::bind(&FromNoeticController::onDamping, this, _1));
    return true;
  }

  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    const franka::RobotState state = state_->getRobotState();
    for (std::size_t i = 0; i < joints_.size(); i++) {
      joints_[i].setCommand(-damping_ * state.dq[i]);
    }
    if (height_.trylock()) {
      height_.msg_.data = state.O_T_EE[14];
      height_.unlockAndPublish();
    }
  }

 private:
  void onDamping(const std_msgs::Float64::ConstPtr& message) { damping_ = message->data; }

  std::unique_ptr<franka_hw::FrankaStateHandle> state_;
  std::vector<hardware_interface::JointHandle> joints_;
  realtime_tools::RealtimePublisher<std_msgs::Float64> height_;
  ros::Subscriber subscriber_;
  double damping_{0.0};
};

}  // namespace from_noetic

PLUGINLIB_EXPORT_CLASS(from_noetic::FromNoeticController, controller_interface::ControllerBase)
