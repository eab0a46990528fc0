// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/actuator_state_interface.h>
#include <hardware_interface/internal/hardware_resource_manager.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// Reads the state of one actuator and commands it. Its interface defines meaning and unit of the
/// command. Real-time safe. Exceptions: the constructors and getName.
class ActuatorHandle : public ActuatorStateHandle {
 public:
  ActuatorHandle() = default;

  /// @throws HardwareInterfaceException if `cmd` is null.
  ActuatorHandle(const ActuatorStateHandle& as, double* cmd) : ActuatorStateHandle(as), cmd_(cmd) {
    if (cmd == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + as.getName() +
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
  /// For transmissions, which write the command directly.
  double* getCommandPtr() {
    assert(cmd_);
    return cmd_;
  }

 private:
  double* cmd_{nullptr};
};

/// Commands of actuators. Nothing is claimed: controllers claim the joints.
class ActuatorCommandInterface : public HardwareResourceManager<ActuatorHandle> {};

/// Efforts: [Nm] for rotary actuators, [N] for linear ones.
class EffortActuatorInterface : public ActuatorCommandInterface {};

/// Velocities: [rad/s] or [m/s].
class VelocityActuatorInterface : public ActuatorCommandInterface {};

/// Positions: [rad] or [m].
class PositionActuatorInterface : public ActuatorCommandInterface {};

}  // namespace hardware_interface
