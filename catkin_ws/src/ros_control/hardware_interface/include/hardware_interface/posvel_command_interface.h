// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>
#include <hardware_interface/joint_state_interface.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// Reads the state of one joint and commands its position ([rad] or [m]) together with its velocity
/// ([rad/s] or [m/s]). Real-time safe. Exceptions: the constructors and getName.
class PosVelJointHandle : public JointStateHandle {
 public:
  PosVelJointHandle() = default;

  /// @throws HardwareInterfaceException when a command pointer is null.
  PosVelJointHandle(const JointStateHandle& js, double* cmd_pos, double* cmd_vel)
      : JointStateHandle(js), cmd_pos_(cmd_pos), cmd_vel_(cmd_vel) {
    if (cmd_pos == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + js.getName() +
                                       "'. Command position pointer is null.");
    }
    if (cmd_vel == nullptr) {
      // Two blanks: the text of the original, which clients may compare with.
      throw HardwareInterfaceException("Cannot create handle '" + js.getName() +
                                       "'. Command velocity  pointer is null.");
    }
  }

  /// @name Sets the commands of this cycle
  /// @{
  void setCommand(double cmd_pos, double cmd_vel) {
    setCommandPosition(cmd_pos);
    setCommandVelocity(cmd_vel);
  }
  void setCommandPosition(double cmd_pos) {
    assert(cmd_pos_);
    *cmd_pos_ = cmd_pos;
  }
  void setCommandVelocity(double cmd_vel) {
    assert(cmd_vel_);
    *cmd_vel_ = cmd_vel;
  }
  /// @}

  /// @name The last commands, and where they stand
  /// @{
  double getCommandPosition() const {
    assert(cmd_pos_);
    return *cmd_pos_;
  }
  double getCommandVelocity() const {
    assert(cmd_vel_);
    return *cmd_vel_;
  }

  const double* getCommandPositionPtr() const {
    assert(cmd_pos_);
    return cmd_pos_;
  }
  const double* getCommandVelocityPtr() const {
    assert(cmd_vel_);
    return cmd_vel_;
  }
  /// @}

 private:
  double* cmd_pos_{nullptr};
  double* cmd_vel_{nullptr};
};

/// Positions with velocities; each joint can be claimed by one controller at a time.
class PosVelJointInterface : public HardwareResourceManager<PosVelJointHandle, ClaimResources> {};

}  // namespace hardware_interface
