// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/resource_manager.h>
#include <joint_limits_interface/detail/effort_handles.h>
#include <joint_limits_interface/detail/position_handles.h>
#include <joint_limits_interface/detail/velocity_handles.h>
#include <joint_limits_interface/joint_limits.h>
#include <joint_limits_interface/joint_limits_interface_exception.h>
#include <ros/duration.h>

#include <stdexcept>
#include <string>

namespace joint_limits_interface {

/// Limits of many joints. A robot calls enforceLimits between its controllers' update and its
/// write(): commands are changed in place. Controllers do not see these interfaces.
/// @tparam HandleType one of the handles of this package
template <class HandleType>
class JointLimitsInterface : public hardware_interface::ResourceManager<HandleType> {
 public:
  /// A copy of the named handle.
  /// @throws JointLimitsInterfaceException for an unknown name.
  HandleType getHandle(const std::string& name) {
    try {
      return hardware_interface::ResourceManager<HandleType>::getHandle(name);
    } catch (const std::logic_error& error) {
      throw JointLimitsInterfaceException(error.what());
    }
  }

  /// Enforces the limits of all joints, in the order of their names. Real-time safe.
  /// @param period since the previous commands [s]
  void enforceLimits(const ros::Duration& period) {
    for (auto& resource : this->resource_map_) {
      resource.second.enforceLimits(period);
    }
  }
};

/// The limits of joints with position commands; they depend on the previous commands.
template <class HandleType>
class PositionLimitsInterface : public JointLimitsInterface<HandleType> {
 public:
  /// Resets the previous commands of all joints. Call it when controllers are switched.
  /// Real-time safe.
  void reset() {
    for (auto& resource : this->resource_map_) {
      resource.second.reset();
    }
  }
};

/// Keeps commanded positions within the limits of the joints.
class PositionJointSaturationInterface
    : public PositionLimitsInterface<PositionJointSaturationHandle> {};
/// Keeps commanded positions within the soft limits of the joints.
class PositionJointSoftLimitsInterface
    : public PositionLimitsInterface<PositionJointSoftLimitsHandle> {};
/// Keeps commanded efforts within the limits of the joints.
class EffortJointSaturationInterface : public JointLimitsInterface<EffortJointSaturationHandle> {};
/// Keeps commanded efforts within the soft limits of the joints.
class EffortJointSoftLimitsInterface : public JointLimitsInterface<EffortJointSoftLimitsHandle> {};
/// Keeps commanded velocities within the limits of the joints.
class VelocityJointSaturationInterface
    : public JointLimitsInterface<VelocityJointSaturationHandle> {};
/// Keeps commanded velocities within the soft limits of the joints.
class VelocityJointSoftLimitsInterface
    : public JointLimitsInterface<VelocityJointSoftLimitsHandle> {};

}  // namespace joint_limits_interface
