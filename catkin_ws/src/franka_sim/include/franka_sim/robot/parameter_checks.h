// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <array>
#include <string>

namespace franka_sim {

/// Whether the arm accepts this payload: finite, mass not negative, inertia symmetric without a
/// negative principal moment, within the limits of franka_core/limits.h. A mass without inertia (a
/// point) is accepted. Real-time safe.
bool isPayload(const franka_core::Payload& payload) noexcept;

/// Why it is not accepted: a sentence with value, limit and unit; empty if it is.
std::string payloadFault(const franka_core::Payload& payload);

/// Largest distance of a frame on the arm from its parent frame [m] (chosen here).
constexpr double kMaxFrameDistance = 10.0;

/// Whether it is a rigid transform to a frame that can be on the arm. Real-time safe.
bool isFrame(const std::array<double, 16>& transform) noexcept;

/// Why it is not one, as the end of a sentence that names it; empty if it is. Not real-time safe.
std::string frameFault(const std::array<double, 16>& transform);

/// Whether all thresholds are finite and not negative. Real-time safe.
bool areThresholds(const CollisionThresholds& thresholds) noexcept;

/// Whether the robot accepts these stiffnesses: 0 to 14250 Nm/rad (protocol 5.7). Real-time safe.
bool isJointStiffness(const std::array<double, 7>& K) noexcept;

/// Likewise: 10 to 3000 N/m, 1 to 300 Nm/rad. Real-time safe.
bool isCartesianStiffness(const std::array<double, 6>& K) noexcept;

/// @throws std::invalid_argument with a sentence that names the first invalid parameter.
void checkParameters(const ControlUnitParameters& parameters);

}  // namespace franka_sim
