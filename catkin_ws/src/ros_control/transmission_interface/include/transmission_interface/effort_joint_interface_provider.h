// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/joint_command_interface_provider.h>

namespace transmission_interface {

/// Provides EffortJointInterface and JointStateInterface: effort commands of joints are mapped to
/// the actuators, the states of actuators to the joints.
class EffortJointInterfaceProvider
    : public internal::JointCommandInterfaceProvider<internal::EffortCommand> {};

}  // namespace transmission_interface
