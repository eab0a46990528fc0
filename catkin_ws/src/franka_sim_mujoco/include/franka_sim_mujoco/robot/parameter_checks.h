// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim_mujoco/robot/control_unit_parameters.h>

namespace franka_sim_mujoco {

/// Whether a body can have these: finite, mass not negative, inertia symmetric without a negative
/// principal moment. A mass without inertia (a point) is fine. Real-time safe.
bool isPayload(const franka_core::Payload& payload) noexcept;

/// Whether all thresholds are finite and not negative. Real-time safe.
bool areThresholds(const CollisionThresholds& thresholds) noexcept;

/// @throws std::invalid_argument with a sentence that names the first parameter which makes no
/// sense.
void checkParameters(const ControlUnitParameters& parameters);

}  // namespace franka_sim_mujoco
