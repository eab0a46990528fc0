// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>
#include <hardware_interface/state_handle.h>

namespace hardware_interface {

namespace internal {
struct JointStateTexts {
  static constexpr const char* kNoAbsolutePosition =
      "Joint state handle does not contain absolute encoder position information";
  static constexpr const char* kNoAbsolutePositionPtr =
      "Joint state handle does not contain absolute position sensor information";
  static constexpr const char* kNoTorqueSensor =
      "Joint state handle does not contain torque sensor information";
};
}  // namespace internal

/// Reads the state of one joint. It points to values that the robot writes in `read()`; copies
/// point to the same values. Units: position [rad] or [m], velocity [rad/s] or [m/s], effort [Nm]
/// or [N]. Real-time safe. Exceptions: the constructors and getName.
class JointStateHandle : public StateHandle<internal::JointStateTexts> {
 public:
  using StateHandle::StateHandle;
};

/// States of joints, for any number of readers.
class JointStateInterface : public HardwareResourceManager<JointStateHandle> {};

}  // namespace hardware_interface
