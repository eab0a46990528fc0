// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/interface_manager.h>

namespace transmission_interface {

/// The transmission interfaces of a robot, by type. Used like the hardware interfaces of RobotHW.
class RobotTransmissions : public hardware_interface::InterfaceManager {};

}  // namespace transmission_interface
