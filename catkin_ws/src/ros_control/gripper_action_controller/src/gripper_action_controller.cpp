// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gripper_action_controller/gripper_action_controller.h>

#include <pluginlib/class_list_macros.hpp>

namespace position_controllers {
typedef gripper_action_controller::GripperActionController<
    hardware_interface::PositionJointInterface>
    GripperActionController;
}
namespace effort_controllers {
typedef gripper_action_controller::GripperActionController<hardware_interface::EffortJointInterface>
    GripperActionController;
}

PLUGINLIB_EXPORT_CLASS(position_controllers::GripperActionController,
                       controller_interface::ControllerBase)
PLUGINLIB_EXPORT_CLASS(effort_controllers::GripperActionController,
                       controller_interface::ControllerBase)
