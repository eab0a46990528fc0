// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <joint_limits_interface/joint_limits.h>
#include <joint_limits_interface/joint_limits_interface.h>
#include <joint_limits_interface/joint_limits_interface_exception.h>
#include <joint_limits_interface/joint_limits_rosparam.h>
#include <joint_limits_interface/joint_limits_urdf.h>

#include <string>

#include "signature.h"

using namespace joint_limits_interface;
using hardware_interface::JointHandle;

EXPECT_BASE(std::exception, JointLimitsInterfaceException);
EXPECT_TYPE(const char*, JointLimitsInterfaceException(std::string()).what());
EXPECT_TYPE(double, internal::saturate(1.0, 2.0, 3.0));

EXPECT_TYPE(double&, (of<JointLimits>().min_position));
EXPECT_TYPE(double&, (of<JointLimits>().max_position));
EXPECT_TYPE(double&, (of<JointLimits>().max_velocity));
EXPECT_TYPE(double&, (of<JointLimits>().max_acceleration));
EXPECT_TYPE(double&, (of<JointLimits>().max_jerk));
EXPECT_TYPE(double&, (of<JointLimits>().max_effort));
EXPECT_TYPE(bool&, (of<JointLimits>().has_position_limits));
EXPECT_TYPE(bool&, (of<JointLimits>().has_velocity_limits));
EXPECT_TYPE(bool&, (of<JointLimits>().has_acceleration_limits));
EXPECT_TYPE(bool&, (of<JointLimits>().has_jerk_limits));
EXPECT_TYPE(bool&, (of<JointLimits>().has_effort_limits));
EXPECT_TYPE(bool&, (of<JointLimits>().angle_wraparound));
EXPECT_TYPE(double&, (of<SoftJointLimits>().min_position));
EXPECT_TYPE(double&, (of<SoftJointLimits>().max_position));
EXPECT_TYPE(double&, (of<SoftJointLimits>().k_position));
EXPECT_TYPE(double&, (of<SoftJointLimits>().k_velocity));

template <class Handle, class Interface, class... Soft>
constexpr bool fits() {
  EXPECT_BASE(JointLimitsInterface<Handle>, Interface);
  EXPECT_BASE(hardware_interface::ResourceManager<Handle>, Interface);
  EXPECT_TYPE(std::string,
              Handle(of<JointHandle>(), of<const JointLimits>(), of<const Soft>()...).getName());
  EXPECT_TYPE(void, of<Handle>().enforceLimits(ros::Duration(0.001)));
  EXPECT_TYPE(void, of<Interface>().enforceLimits(ros::Duration(0.001)));
  EXPECT_TYPE(void, of<Interface>().registerHandle(of<Handle>()));
  EXPECT_TYPE(Handle, of<Interface>().getHandle(std::string()));
  return true;
}
static_assert(fits<PositionJointSaturationHandle, PositionJointSaturationInterface>(), "");
static_assert(fits<VelocityJointSaturationHandle, VelocityJointSaturationInterface>(), "");
static_assert(fits<EffortJointSaturationHandle, EffortJointSaturationInterface>(), "");
static_assert(
    fits<PositionJointSoftLimitsHandle, PositionJointSoftLimitsInterface, SoftJointLimits>(), "");
static_assert(
    fits<VelocityJointSoftLimitsHandle, VelocityJointSoftLimitsInterface, SoftJointLimits>(), "");
static_assert(fits<EffortJointSoftLimitsHandle, EffortJointSoftLimitsInterface, SoftJointLimits>(),
              "");
EXPECT_TYPE(void, of<PositionJointSaturationHandle>().reset());
EXPECT_TYPE(void, of<PositionJointSoftLimitsHandle>().reset());
EXPECT_TYPE(void, of<PositionJointSaturationInterface>().reset());
EXPECT_TYPE(void, of<PositionJointSoftLimitsInterface>().reset());
static_assert(std::is_default_constructible<PositionJointSoftLimitsHandle>::value, "");
static_assert(std::is_default_constructible<EffortJointSoftLimitsHandle>::value, "");
static_assert(std::is_default_constructible<VelocityJointSaturationHandle>::value, "");

EXPECT_TYPE(bool, getJointLimits(urdf::JointConstSharedPtr(), of<JointLimits>()));
EXPECT_TYPE(bool, getSoftJointLimits(urdf::JointConstSharedPtr(), of<SoftJointLimits>()));
EXPECT_TYPE(bool, getJointLimits(std::string(), of<const ros::NodeHandle>(), of<JointLimits>()));
EXPECT_TYPE(bool,
            getSoftJointLimits(std::string(), of<const ros::NodeHandle>(), of<SoftJointLimits>()));
