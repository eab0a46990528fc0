// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/joint_command_interface_provider.h>

namespace transmission_interface {

/// Provides VelocityJointInterface and JointStateInterface: velocity commands of joints are mapped
/// to the actuators, the states of actuators to the joints.
class VelocityJointInterfaceProvider
    : public internal::JointCommandInterfaceProvider<internal::VelocityCommand> {};

}  // namespace transmission_interface
