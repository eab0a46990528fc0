// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/joint_command_interface.h>

#include <type_traits>

namespace forward_command_controller {
namespace detail {

/// Whether a command of zero stops the joint, which is not so for positions.
template <class T>
constexpr bool kZeroIsRest = std::is_base_of<hardware_interface::EffortJointInterface, T>::value ||
                             std::is_base_of<hardware_interface::VelocityJointInterface, T>::value;

/// Stops a joint when its controller ends: a velocity or an effort of zero; a position stays
/// unchanged. Real-time safe.
template <class T>
void rest(hardware_interface::JointHandle& joint) {
  if (kZeroIsRest<T>) {
    joint.setCommand(0.0);
  }
}

}  // namespace detail
}  // namespace forward_command_controller
