// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/hardware_interface.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/console.h>

#include <array>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// The handle of a resource. For the initialization of controllers, not for the loop.
/// @throws hardware_interface::HardwareInterfaceException with a sentence if the robot lacks it
template <typename Interface>
auto takeHandle(hardware_interface::RobotHW* robot_hw, const std::string& resource) {
  auto* interface = robot_hw->get<Interface>();
  if (interface == nullptr) {
    throw hardware_interface::HardwareInterfaceException(
        "The robot does not offer " + hardware_interface::internal::demangledTypeName<Interface>() +
        ".");
  }
  return interface->getHandle(resource);
}

/// The handles of several joints, in order. @throws like takeHandle
template <typename Interface>
std::vector<hardware_interface::JointHandle> takeJoints(hardware_interface::RobotHW* robot_hw,
                                                        const std::vector<std::string>& names) {
  std::vector<hardware_interface::JointHandle> handles;
  handles.reserve(names.size());
  for (const std::string& name : names) {
    handles.push_back(takeHandle<Interface>(robot_hw, name));
  }
  return handles;
}

/// Runs `take`, which gets handles of an arm.
/// @returns false, after one sentence in the log, if the robot lacks one of them
template <typename Take>
bool takeHandles(const char* controller, const std::string& arm_id, Take take) {
  try {
    take();
    return true;
  } catch (const hardware_interface::HardwareInterfaceException& error) {
    ROS_ERROR(
        "%s: the robot lacks something of arm '%s'; check the parameters arm_id and joint_names. "
        "%s",
        controller, arm_id.c_str(), error.what());
    return false;
  }
}

/// Whether every joint is within 0.1 rad of the start of the example motions.
/// @returns false after one sentence in the log with a way to get there
bool isAtStartPose(const char* controller, const std::array<double, 7>& q);

}  // namespace franka_example_controllers
