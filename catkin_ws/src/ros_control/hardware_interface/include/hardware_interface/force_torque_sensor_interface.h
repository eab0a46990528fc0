// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>

#include <string>

namespace hardware_interface {

/// Reads one force-torque sensor. Force [N] and torque [Nm] are vectors of three (x, y, z) in the
/// sensor's frame, written by the robot in `read()`; for a missing quantity the pointer is null.
/// Real-time safe. Exceptions: the constructor, getName and getFrameId.
class ForceTorqueSensorHandle {
 public:
  ForceTorqueSensorHandle() = default;
  ForceTorqueSensorHandle(const std::string& name, const std::string& frame_id, const double* force,
                          const double* torque)
      : name_(name), frame_id_(frame_id), force_(force), torque_(torque) {}

  /// @name The sensor and its measured values
  /// @{
  std::string getName() const { return name_; }
  std::string getFrameId() const { return frame_id_; }
  const double* getForce() const { return force_; }
  const double* getTorque() const { return torque_; }
  /// @}

 private:
  std::string name_;
  std::string frame_id_;
  const double* force_{nullptr};
  const double* torque_{nullptr};
};

/// Force-torque sensors, for any number of readers.
class ForceTorqueSensorInterface : public HardwareResourceManager<ForceTorqueSensorHandle> {};

}  // namespace hardware_interface
