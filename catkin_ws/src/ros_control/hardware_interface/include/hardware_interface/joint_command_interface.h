// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>
#include <hardware_interface/joint_state_interface.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// Reads the state of one joint and commands it. Its interface defines meaning and unit of the
/// command. Real-time safe. Exceptions: the constructors and getName.
class JointHandle : public JointStateHandle {
 public:
  JointHandle() = default;

  /// @throws HardwareInterfaceException if `cmd` is null.
  JointHandle(const JointStateHandle& js, double* cmd) : JointStateHandle(js), cmd_(cmd) {
    if (cmd == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + js.getName() +
                                       "'. Command data pointer is null.");
    }
  }

  /// Sets the command of this cycle.
  void setCommand(double command) {
    assert(cmd_);
    *cmd_ = command;
  }
  /// The last command.
  double getCommand() const {
    assert(cmd_);
    return *cmd_;
  }
  /// The address of the command.
  const double* getCommandPtr() const {
    assert(cmd_);
    return cmd_;
  }

 private:
  double* cmd_{nullptr};
};

/// Commands of joints; each joint can be claimed by one controller at a time.
class JointCommandInterface : public HardwareResourceManager<JointHandle, ClaimResources> {};

/// Efforts: [Nm] for revolute joints, [N] for prismatic ones.
class EffortJointInterface : public JointCommandInterface {};

/// Velocities: [rad/s] or [m/s].
class VelocityJointInterface : public JointCommandInterface {};

/// Positions: [rad] or [m].
class PositionJointInterface : public JointCommandInterface {};

}  // namespace hardware_interface
