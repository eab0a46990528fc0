// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <joint_trajectory_controller/joint_trajectory_controller.h>
#include <trajectory_interface/quintic_spline_segment.h>

#include <pluginlib/class_list_macros.hpp>

namespace {

template <class HardwareInterface>
using Controller = joint_trajectory_controller::JointTrajectoryController<
    trajectory_interface::QuinticSplineSegment<double>, HardwareInterface>;

}  // namespace

namespace position_controllers {
typedef Controller<hardware_interface::PositionJointInterface> JointTrajectoryController;
}
namespace velocity_controllers {
typedef Controller<hardware_interface::VelocityJointInterface> JointTrajectoryController;
}
namespace effort_controllers {
typedef Controller<hardware_interface::EffortJointInterface> JointTrajectoryController;
}
namespace pos_vel_controllers {
typedef Controller<hardware_interface::PosVelJointInterface> JointTrajectoryController;
}
namespace pos_vel_acc_controllers {
typedef Controller<hardware_interface::PosVelAccJointInterface> JointTrajectoryController;
}

PLUGINLIB_EXPORT_CLASS(position_controllers::JointTrajectoryController,
                       controller_interface::ControllerBase)
PLUGINLIB_EXPORT_CLASS(velocity_controllers::JointTrajectoryController,
                       controller_interface::ControllerBase)
PLUGINLIB_EXPORT_CLASS(effort_controllers::JointTrajectoryController,
                       controller_interface::ControllerBase)
PLUGINLIB_EXPORT_CLASS(pos_vel_controllers::JointTrajectoryController,
                       controller_interface::ControllerBase)
PLUGINLIB_EXPORT_CLASS(pos_vel_acc_controllers::JointTrajectoryController,
                       controller_interface::ControllerBase)
