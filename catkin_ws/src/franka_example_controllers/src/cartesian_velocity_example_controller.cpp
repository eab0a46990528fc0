// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/cartesian_velocity_example_controller.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>

#include <cmath>

namespace franka_example_controllers {

bool CartesianVelocityExampleController::init(hardware_interface::RobotHW* robot_hw,
                                              ros::NodeHandle& node_handle) {
  std::string arm_id;
  return readArmId(kName, node_handle, arm_id) &&
         takeHandles(kName, arm_id,
                     [&] {
                       velocity_handle_ =
                           std::make_unique<franka_hw::FrankaCartesianVelocityHandle>(
                               takeHandle<franka_hw::FrankaVelocityCartesianInterface>(
                                   robot_hw, arm_id + "_robot"));
                     }) &&
         isAtStartPose(kName, velocity_handle_->getRobotState().q_d);
}

void CartesianVelocityExampleController::starting(const ros::Time& /*time*/) { elapsed_ = 0.0; }

void CartesianVelocityExampleController::update(const ros::Time& /*time*/,
                                                const ros::Duration& period) {
  elapsed_ += period.toSec();
  // Every second cycle moves back.
  const double direction = std::fmod(elapsed_, 2.0 * kCycle) < kCycle ? 1.0 : -1.0;
  const double v = direction * kMaxVelocity / 2.0 * (1.0 - std::cos(2.0 * kPi / kCycle * elapsed_));
  const std::array<double, 6> command{
      {std::cos(kSlope) * v, 0.0, -std::sin(kSlope) * v, 0.0, 0.0, 0.0}};
  velocity_handle_->setCommand(command);
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::CartesianVelocityExampleController,
                       controller_interface::ControllerBase)
