// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>
#include <franka_core/robot_state.h>

#include <array>

#include "robot/limits/error_set.h"

namespace franka_sim {

/// Limits of the measured arm, in every mode with motor control (decision 14). The motion
/// generators check the commands; these limits are at least 5 % wider, so that an arm which follows
/// its commands well is not stopped.
/// @param O_dP_EE measured twist of EE in O [m/s, rad/s]
/// @returns the errors out of: tau_J_range_violation (|tau_J| above 1.2 times the motors' range),
/// joint_position_limits_violation (0.005 rad beyond), joint_velocity_violation (1.05 times),
/// cartesian velocity (1.05 times that of the translation), power_limit_violation (kPowerLimit).
/// Real-time safe.
ErrorSet measuredViolations(const franka_core::ArmLimits& limits,
                            const franka_core::RobotState& state,
                            const std::array<double, 6>& O_dP_EE) noexcept;

/// Sum of |tau_J dq| over the joints [W]. Chosen here: the data sheet gives a peak electrical power
/// of about 350 W, and the mechanical power cannot exceed it.
constexpr double kPowerLimit = 350.0;

/// Whether a joint is 0.005 rad or more beyond its limits, so that the user must move it back.
/// Real-time safe.
bool beyondJointLimits(const franka_core::ArmLimits& limits,
                       const std::array<double, 7>& q) noexcept;

}  // namespace franka_sim
