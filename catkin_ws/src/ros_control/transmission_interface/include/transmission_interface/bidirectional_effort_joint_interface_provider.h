// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/joint_command_interface_provider.h>

namespace transmission_interface {

/// Like EffortJointInterfaceProvider, with maps for the opposite direction too: states from joints
/// to actuators, effort commands from actuators to joints.
class BiDirectionalEffortJointInterfaceProvider
    : public internal::BiDirectionalInterfaceProvider<internal::EffortCommand> {};

}  // namespace transmission_interface
