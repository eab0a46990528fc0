// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <cstdint>
#include <string>
#include <vector>

/// @file
/// The models that a robot sends to its clients. Both hold the arm's links alone, like the control
/// unit's own model; clients add end effector and load.

namespace franka_sim::fci {

/// The shared object for clients of protocols 3 to 9: 30 C functions (protocol 8.1) that need only
/// libc and libm, with this arm's parameters. For the machine's own architecture.
/// @throws std::logic_error if the library of this build lacks the block for parameters.
std::vector<std::uint8_t> servedLibrary(const franka_core::ArmModel& arm);

/// The URDF for clients of protocols 8 to 10: links link0 to link8 (the flange, last), joints
/// joint1 to joint8 without a prefix, limits of this protocol version and, as those clients demand,
/// position_based_velocity_limits. Numbers read back to the same doubles.
std::string servedUrdf(const franka_core::ArmModel& arm, unsigned protocol_version);

}  // namespace franka_sim::fci
