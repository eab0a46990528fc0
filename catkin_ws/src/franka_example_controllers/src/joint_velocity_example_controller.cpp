// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/joint_velocity_example_controller.h>
#include <franka_example_controllers/pi.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>

#include <cmath>

namespace franka_example_controllers {

bool JointVelocityExampleController::init(hardware_interface::RobotHW* robot_hw,
                                          ros::NodeHandle& node_handle) {
  std::string arm_id;
  std::vector<std::string> joint_names;
  if (!readArmId(kName, node_handle, arm_id) || !readJointNames(kName, node_handle, joint_names)) {
    return false;
  }
  std::array<double, 7> q_d{};
  return takeHandles(kName, arm_id,
                     [&] {
                       joint_handles_ = takeJoints<hardware_interface::VelocityJointInterface>(
                           robot_hw, joint_names);
                       q_d =
                           takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm_id + "_robot")
                               .getRobotState()
                               .q_d;
                     }) &&
         isAtStartPose(kName, q_d);
}

void JointVelocityExampleController::starting(const ros::Time& /*time*/) { elapsed_ = 0.0; }

void JointVelocityExampleController::update(const ros::Time& /*time*/,
                                            const ros::Duration& period) {
  elapsed_ += period.toSec();
  // Every second cycle moves back.
  const double direction = std::fmod(elapsed_, 2.0 * kCycle) < kCycle ? 1.0 : -1.0;
  const double omega =
      direction * kMaxVelocity / 2.0 * (1.0 - std::cos(2.0 * kPi / kCycle * elapsed_));
  for (hardware_interface::JointHandle& joint : joint_handles_) {
    joint.setCommand(omega);
  }
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::JointVelocityExampleController,
                       controller_interface::ControllerBase)
