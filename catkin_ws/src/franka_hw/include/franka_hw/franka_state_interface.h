// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <franka/robot_state.h>
#include <hardware_interface/internal/hardware_resource_manager.h>

#include <string>

namespace franka_hw {

/// Read access to the complete state of one arm.
///
/// The handle refers to the state of its hardware, which read() updates once a cycle, and must not
/// outlive it. Called by the thread that calls the controllers. Real-time safe.
class FrankaStateHandle {
 public:
  FrankaStateHandle() = delete;

  /// @param name resource name, `<arm_id>_robot`
  /// @param robot_state the state of the handle; referenced, not copied
  FrankaStateHandle(const std::string& name, franka::RobotState& robot_state)
      : name_(name), robot_state_(&robot_state) {}

  /// The resource's name.
  const std::string& getName() const noexcept { return name_; }

  /// A reference to the state, which changes with every cycle.
  const franka::RobotState& getRobotState() const noexcept { return *robot_state_; }

 private:
  std::string name_;
  const franka::RobotState* robot_state_;
};

/// Provides FrankaStateHandles by name; any number of controllers may read at the same time.
class FrankaStateInterface : public hardware_interface::HardwareResourceManager<FrankaStateHandle> {
};

}  // namespace franka_hw
