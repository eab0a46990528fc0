// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/posvel_command_interface.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// A PosVelJointHandle that commands the acceleration ([rad/s^2] or [m/s^2]) as well.
/// Real-time safe. Exceptions: the constructors and getName.
class PosVelAccJointHandle : public PosVelJointHandle {
 public:
  PosVelAccJointHandle() = default;

  /// @throws HardwareInterfaceException when a command pointer is null.
  PosVelAccJointHandle(const JointStateHandle& js, double* cmd_pos, double* cmd_vel,
                       double* cmd_acc)
      : PosVelJointHandle(js, cmd_pos, cmd_vel), cmd_acc_(cmd_acc) {
    if (cmd_acc == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + js.getName() +
                                       "'. Command acceleration data pointer is null.");
    }
  }

  /// @name Sets the commands of this cycle
  /// @{
  void setCommand(double cmd_pos, double cmd_vel, double cmd_acc) {
    PosVelJointHandle::setCommand(cmd_pos, cmd_vel);
    setCommandAcceleration(cmd_acc);
  }
  void setCommandAcceleration(double cmd_acc) {
    assert(cmd_acc_);
    *cmd_acc_ = cmd_acc;
  }
  /// @}

  /// @name The last command, and where it stands
  /// @{
  double getCommandAcceleration() const {
    assert(cmd_acc_);
    return *cmd_acc_;
  }
  const double* getCommandAccelerationPtr() const {
    assert(cmd_acc_);
    return cmd_acc_;
  }
  /// @}

 private:
  double* cmd_acc_{nullptr};
};

/// Positions with velocities and accelerations; each joint can be claimed by one controller at a
/// time.
class PosVelAccJointInterface
    : public HardwareResourceManager<PosVelAccJointHandle, ClaimResources> {};

}  // namespace hardware_interface
