// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <joint_limits_interface/joint_limits_interface.h>
#include <joint_limits_interface/joint_limits_interface_exception.h>

#include <string>

#include "signature.h"

using namespace joint_limits_interface;

EXPECT_BASE(std::exception, JointLimitsInterfaceException);

template <class Handle, class Interface>
constexpr bool fits() {
  EXPECT_BASE(JointLimitsInterface<Handle>, Interface);
  EXPECT_BASE(hardware_interface::ResourceManager<Handle>, Interface);
  EXPECT_TYPE(void, of<Interface>().enforceLimits(ros::Duration(0.001)));
  EXPECT_TYPE(void, of<Interface>().registerHandle(of<Handle>()));
  EXPECT_TYPE(Handle, of<Interface>().getHandle(std::string()));
  return true;
}
static_assert(fits<PositionJointSaturationHandle, PositionJointSaturationInterface>(), "");
static_assert(fits<VelocityJointSaturationHandle, VelocityJointSaturationInterface>(), "");
static_assert(fits<EffortJointSaturationHandle, EffortJointSaturationInterface>(), "");
static_assert(fits<PositionJointSoftLimitsHandle, PositionJointSoftLimitsInterface>(), "");
static_assert(fits<VelocityJointSoftLimitsHandle, VelocityJointSoftLimitsInterface>(), "");
static_assert(fits<EffortJointSoftLimitsHandle, EffortJointSoftLimitsInterface>(), "");
