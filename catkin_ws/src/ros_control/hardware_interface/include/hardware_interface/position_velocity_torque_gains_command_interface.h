// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/posvel_command_interface.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// A PosVelJointHandle that commands a feed-forward effort ([Nm] or [N]) and the gains of the
/// joint's own controller as well: kp of the position ([Nm/rad] or [N/m]) and kd of its derivative
/// ([Nms/rad] or [Ns/m]). Real-time safe. Exceptions: the constructors and getName.
class PositionVelocityTorqueGainsJointHandle : public PosVelJointHandle {
 public:
  PositionVelocityTorqueGainsJointHandle() = default;

  /// @throws HardwareInterfaceException when a command pointer is null.
  PositionVelocityTorqueGainsJointHandle(const JointStateHandle& js, double* cmd_pos,
                                         double* cmd_vel, double* cmd_eff, double* cmd_kp,
                                         double* cmd_kd)
      : PosVelJointHandle(js, cmd_pos, cmd_vel),
        cmd_eff_(require(cmd_eff, "effort")),
        cmd_kp_(require(cmd_kp, "position gain")),
        cmd_kd_(require(cmd_kd, "derivative gain")) {}

  /// @name Sets the commands of this cycle
  /// @{
  void setCommand(double cmd_pos, double cmd_vel, double cmd_eff, double cmd_kp, double cmd_kd) {
    PosVelJointHandle::setCommand(cmd_pos, cmd_vel);
    setCommandEffort(cmd_eff);
    setCommandKp(cmd_kp);
    setCommandKd(cmd_kd);
  }
  void setCommandEffort(double cmd_eff) {
    assert(cmd_eff_);
    *cmd_eff_ = cmd_eff;
  }
  void setCommandKp(double cmd_kp) {
    assert(cmd_kp_);
    *cmd_kp_ = cmd_kp;
  }
  void setCommandKd(double cmd_kd) {
    assert(cmd_kd_);
    *cmd_kd_ = cmd_kd;
  }
  /// @}

  /// @name The last commands
  /// @{
  double getCommandEffort() const {
    assert(cmd_eff_);
    return *cmd_eff_;
  }
  double getCommandKp() const {
    assert(cmd_kp_);
    return *cmd_kp_;
  }
  double getCommandKd() const {
    assert(cmd_kd_);
    return *cmd_kd_;
  }
  /// @}

 private:
  double* require(double* command, const char* quantity) const {
    if (command == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + getName() + "'. Command " +
                                       quantity + " data pointer is null.");
    }
    return command;
  }

  double* cmd_eff_{nullptr};
  double* cmd_kp_{nullptr};
  double* cmd_kd_{nullptr};
};

/// Positions with velocities, efforts and gains; each joint can be claimed by one controller at a
/// time.
class PositionVelocityTorqueGainsJointInterface
    : public HardwareResourceManager<PositionVelocityTorqueGainsJointHandle, ClaimResources> {};

}  // namespace hardware_interface
