// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>

#include <cassert>
#include <string>

namespace hardware_interface {

/// Limits the effort with which one joint's drive follows commanded positions. Real-time safe.
/// Exceptions: the constructor and getName.
class JointEffortLimitHandle {
 public:
  JointEffortLimitHandle() = default;

  /// @param max_effort [Nm] or [N]. @throws HardwareInterfaceException if it is null.
  JointEffortLimitHandle(std::string name, double* max_effort)
      : name_(name), max_effort_(max_effort) {
    if (max_effort == nullptr) {
      throw HardwareInterfaceException("Cannot create handle '" + name +
                                       "'. Effort limit data pointer is null.");
    }
  }

  /// The name of the joint.
  std::string getName() const { return name_; }

  /// @param max_effort [Nm] or [N]; 0: only the drive's own maximum
  void setMaxEffort(double max_effort) {
    assert(max_effort_);
    *max_effort_ = max_effort;
  }

 private:
  std::string name_;
  double* max_effort_{nullptr};
};

/// Effort limits of joints with position commands, as an addition to PositionJointInterface that
/// hardware may offer. getHandle claims nothing: the controller that has claimed the joint sets the
/// limit while it runs, and resets it to 0 when it stops.
class JointEffortLimitInterface : public HardwareResourceManager<JointEffortLimitHandle> {};

}  // namespace hardware_interface
