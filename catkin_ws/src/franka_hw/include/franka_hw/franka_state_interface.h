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
/// The handle refers to the state its hardware owns, which read() refreshes once a cycle; it must
/// not outlive it. Real-time safe; to be used in the thread that calls the controllers.
class FrankaStateHandle {
 public:
  FrankaStateHandle() = delete;

  /// @param name resource name, `<arm_id>_robot`
  /// @param robot_state the state the handle shows; referenced, not copied
  FrankaStateHandle(const std::string& name, franka::RobotState& robot_state)
      : name_(name), robot_state_(&robot_state) {}

  const std::string& getName() const noexcept { return name_; }

  /// The state itself, not a copy: it changes with every cycle.
  const franka::RobotState& getRobotState() const noexcept { return *robot_state_; }

 private:
  std::string name_;
  const franka::RobotState* robot_state_;
};

/// Hands out FrankaStateHandles by name; any number of controllers may read at once.
class FrankaStateInterface : public hardware_interface::HardwareResourceManager<FrankaStateHandle> {
};

}  // namespace franka_hw
