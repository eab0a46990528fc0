// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_interface/multi_interface_controller.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <pluginlib/class_list_macros.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

namespace my_arm {

class SpringController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaModelInterface, hardware_interface::EffortJointInterface,
          franka_hw::FrankaStateInterface> {
 public:
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override {
    std::string arm_id;
    std::vector<std::string> joint_names;
    if (!node_handle.getParam("arm_id", arm_id) ||
        !node_handle.getParam("joint_names", joint_names) || joint_names.size() != 7 ||
        !node_handle.getParam("away", away_)) {
      ROS_ERROR("SpringController: arm_id, joint_names or away is missing");
      return false;
    }
    model_ = std::make_unique<franka_hw::FrankaModelHandle>(
        robot_hw->get<franka_hw::FrankaModelInterface>()->getHandle(arm_id + "_model"));
    state_ = std::make_unique<franka_hw::FrankaStateHandle>(
        robot_hw->get<franka_hw::FrankaStateInterface>()->getHandle(arm_id + "_robot"));
    auto* effort = robot_hw->get<hardware_interface::EffortJointInterface>();
    for (const auto& name : joint_names) {
      joints_.push_back(effort->getHandle(name));
    }
    return true;
  }

  void starting(const ros::Time& /*time*/) override {
    begin_ = state_->getRobotState().q;
    progress_ = 0.0;
  }

  void update(const ros::Time& /*time*/, const ros::Duration& period) override {
    progress_ = std::min(1.0, progress_ + period.toSec());
    const double smooth = progress_ * progress_ * (3.0 - 2.0 * progress_);
    const std::array<double, 7> coriolis = model_->getCoriolis();
    const franka::RobotState& state = state_->getRobotState();
    for (size_t i = 0; i < 7; ++i) {
      const double target = begin_[i] + away_ * smooth;
      joints_[i].setCommand(300.0 * (target - state.q[i]) - 30.0 * state.dq[i] + coriolis[i]);
    }
  }

 private:
  double away_{0.0};
  double progress_{0.0};
  std::array<double, 7> begin_{};
  std::unique_ptr<franka_hw::FrankaModelHandle> model_;
  std::unique_ptr<franka_hw::FrankaStateHandle> state_;
  std::vector<hardware_interface::JointHandle> joints_;
};

}  // namespace my_arm

PLUGINLIB_EXPORT_CLASS(my_arm::SpringController, controller_interface::ControllerBase)
