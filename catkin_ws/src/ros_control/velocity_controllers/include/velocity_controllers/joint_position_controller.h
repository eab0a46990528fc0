// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <forward_command_controller/detail/joint_position_controller.h>

namespace velocity_controllers {

/// Holds one joint at the position of the topic `command`, by a Pid that commands its velocity; see
/// its base class.
class JointPositionController : public forward_command_controller::detail::JointPositionController<
                                    hardware_interface::VelocityJointInterface> {};

}  // namespace velocity_controllers
