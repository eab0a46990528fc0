// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/joint_position_example_controller.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>

#include <cmath>

namespace franka_example_controllers {

bool JointPositionExampleController::init(hardware_interface::RobotHW* robot_hw,
                                          ros::NodeHandle& node_handle) {
  std::vector<std::string> joint_names;
  if (!readJointNames(kName, node_handle, joint_names)) {
    return false;
  }
  if (!takeHandles(kName, joint_names.front(), [&] {
        joint_handles_ =
            takeJoints<hardware_interface::PositionJointInterface>(robot_hw, joint_names);
      })) {
    return false;
  }
  std::array<double, 7> q{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = joint_handles_[i].getPosition();
  }
  return isAtStartPose(kName, q);
}

void JointPositionExampleController::starting(const ros::Time& /*time*/) {
  for (std::size_t i = 0; i < q_start_.size(); ++i) {
    q_start_[i] = joint_handles_[i].getPosition();
  }
  elapsed_ = 0.0;
}

void JointPositionExampleController::update(const ros::Time& /*time*/,
                                            const ros::Duration& period) {
  elapsed_ += period.toSec();
  const double swing = kSwing / 2.0 * (1.0 - std::cos(2.0 * kPi / kCycle * elapsed_));
  for (std::size_t i = 0; i < joint_handles_.size(); ++i) {
    joint_handles_[i].setCommand(q_start_[i] + (i == kOpposite ? -swing : swing));
  }
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::JointPositionExampleController,
                       controller_interface::ControllerBase)
