// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/joint_command_interface_provider.h>

namespace transmission_interface {

/// Like VelocityJointInterfaceProvider, with maps for the opposite direction too: states from
/// joints to actuators, velocity commands from actuators to joints.
class BiDirectionalVelocityJointInterfaceProvider
    : public internal::BiDirectionalInterfaceProvider<internal::VelocityCommand> {};

}  // namespace transmission_interface
