// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// Command mode of a joint's drive. The values are fixed: drivers exchange them as ints.
enum class JointCommandModes {
  BEGIN = -1,
  MODE_POSITION = 0,
  MODE_VELOCITY = 1,
  MODE_EFFORT = 2,
  NOMODE = 3,
  EMERGENCY_STOP = 4,
  SWITCHING = 5,
  ERROR = 6
};

/// Reads and requests the mode of one joint's drive. Real-time safe. Exceptions: the constructor,
/// getName and getModeName.
class JointModeHandle {
 public:
  JointModeHandle() = default;

  /// @throws HardwareInterfaceException if `mode` is null.
  JointModeHandle(std::string name, JointCommandModes* mode) : name_(name), mode_(mode) {
    if (mode == nullptr) {
      throw HardwareInterfaceException("Cannot create mode interface. Mode data pointer is null.");
    }
  }

  /// The name of the joint.
  std::string getName() const { return name_; }

  /// Requests a mode.
  void setMode(JointCommandModes mode) {
    assert(mode_);
    *mode_ = mode;
  }
  /// The requested mode, or the one that the drive reports.
  JointCommandModes getMode() const {
    assert(mode_);
    return *mode_;
  }
  /// The address of the mode.
  const JointCommandModes* getModePtr() const {
    assert(mode_);
    return mode_;
  }

  /// Name of a mode for messages; "unknown" for an invalid value.
  static std::string getModeName(JointCommandModes mode) {
    switch (mode) {
      case JointCommandModes::BEGIN:
        return "not_operational";
      case JointCommandModes::MODE_POSITION:
        return "position";
      case JointCommandModes::MODE_VELOCITY:
        return "velocity";
      case JointCommandModes::MODE_EFFORT:
        return "effort";
      case JointCommandModes::NOMODE:
        return "other";
      case JointCommandModes::EMERGENCY_STOP:
        return "emergency_stop";
      case JointCommandModes::SWITCHING:
        return "switching";
      case JointCommandModes::ERROR:
        return "error";
    }
    return "unknown";
  }

 private:
  std::string name_;
  JointCommandModes* mode_{nullptr};
};

/// Modes of joints; getHandle claims nothing.
class JointModeInterface : public HardwareResourceManager<JointModeHandle> {};

}  // namespace hardware_interface
