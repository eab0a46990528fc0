// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/cartesian_pose_example_controller.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>

#include <cmath>

namespace franka_example_controllers {

bool CartesianPoseExampleController::init(hardware_interface::RobotHW* robot_hw,
                                          ros::NodeHandle& node_handle) {
  std::string arm_id;
  return readArmId(kName, node_handle, arm_id) &&
         takeHandles(kName, arm_id,
                     [&] {
                       pose_handle_ = std::make_unique<franka_hw::FrankaCartesianPoseHandle>(
                           takeHandle<franka_hw::FrankaPoseCartesianInterface>(robot_hw,
                                                                               arm_id + "_robot"));
                     }) &&
         isAtStartPose(kName, pose_handle_->getRobotState().q_d);
}

void CartesianPoseExampleController::starting(const ros::Time& /*time*/) {
  O_T_EE_start_ = pose_handle_->getRobotState().O_T_EE_d;
  elapsed_ = 0.0;
}

void CartesianPoseExampleController::update(const ros::Time& /*time*/,
                                            const ros::Duration& period) {
  elapsed_ += period.toSec();
  const double angle = kSweep / 2.0 * (1.0 - std::cos(2.0 * kPi / kCycle * elapsed_));
  std::array<double, 16> pose = O_T_EE_start_;
  pose[12] -= kRadius * std::sin(angle);
  pose[14] -= kRadius * (std::cos(angle) - 1.0);
  pose_handle_->setCommand(pose);
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::CartesianPoseExampleController,
                       controller_interface::ControllerBase)
