// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/model_example_controller.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>

#include <sstream>

namespace franka_example_controllers {

namespace {

template <std::size_t size>
std::string text(const std::array<double, size>& values) {
  std::ostringstream out;
  out << "[";
  for (std::size_t i = 0; i < size; ++i) {
    out << (i == 0 ? "" : ",") << values[i];
  }
  out << "]";
  return out.str();
}

}  // namespace

bool ModelExampleController::init(hardware_interface::RobotHW* robot_hw,
                                  ros::NodeHandle& node_handle) {
  std::string arm_id;
  if (!readArmId(kName, node_handle, arm_id) || !takeHandles(kName, arm_id, [&] {
        model_handle_ = std::make_unique<franka_hw::FrankaModelHandle>(
            takeHandle<franka_hw::FrankaModelInterface>(robot_hw, arm_id + "_model"));
        state_handle_ = std::make_unique<franka_hw::FrankaStateHandle>(
            takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm_id + "_robot"));
      })) {
    return false;
  }
  timer_ = node_handle.createWallTimer(ros::WallDuration(kPrintPeriod),
                                       [this](const auto& /*event*/) { print(); });
  return true;
}

void ModelExampleController::starting(const ros::Time& time) {
  rate_ = franka_hw::TriggerRate(1.0, time);
}

void ModelExampleController::update(const ros::Time& time, const ros::Duration& /*period*/) {
  if (!rate_(time)) {
    return;
  }
  computed_.number++;
  computed_.mass = model_handle_->getMass();
  computed_.coriolis = model_handle_->getCoriolis();
  computed_.gravity = model_handle_->getGravity();
  computed_.O_T_J4 = model_handle_->getPose(franka::Frame::kJoint4);
  computed_.J4_J = model_handle_->getBodyJacobian(franka::Frame::kJoint4);
  computed_.O_J_EE = model_handle_->getZeroJacobian(franka::Frame::kEndEffector);
  answers_.write(computed_);
}

void ModelExampleController::print() {
  const Answers& answers = answers_.read();
  if (answers.number == printed_) {
    return;
  }
  printed_ = answers.number;
  ROS_INFO_STREAM("mass :" << text(answers.mass));
  ROS_INFO_STREAM("coriolis: " << text(answers.coriolis));
  ROS_INFO_STREAM("gravity :" << text(answers.gravity));
  ROS_INFO_STREAM("joint_pose :" << text(answers.O_T_J4));
  ROS_INFO_STREAM("joint4_body_jacobian :" << text(answers.J4_J));
  ROS_INFO_STREAM("joint_zero_jacobian :" << text(answers.O_J_EE));
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::ModelExampleController,
                       controller_interface::ControllerBase)
