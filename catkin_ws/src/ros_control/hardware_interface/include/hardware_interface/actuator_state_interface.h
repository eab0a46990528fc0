// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>
#include <hardware_interface/state_handle.h>

namespace hardware_interface {

namespace internal {
struct ActuatorStateTexts {
  static constexpr const char* kNoAbsolutePosition = "Actuator does not support absolute encoders";
  static constexpr const char* kNoAbsolutePositionPtr = kNoAbsolutePosition;
  static constexpr const char* kNoTorqueSensor = "Actuator does not support torque sensors";
};
}  // namespace internal

/// Reads the state of one actuator, the motor's side of a transmission. It points to values that
/// the robot writes in `read()`; copies point to the same values. Units: position [rad] or [m],
/// velocity [rad/s] or [m/s], effort [Nm] or [N]. Real-time safe. Exceptions: the constructors and
/// getName.
class ActuatorStateHandle : public StateHandle<internal::ActuatorStateTexts> {
 public:
  using StateHandle::StateHandle;
};

/// States of actuators, for any number of readers.
class ActuatorStateInterface : public HardwareResourceManager<ActuatorStateHandle> {};

}  // namespace hardware_interface
