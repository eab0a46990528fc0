// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace franka_sim::physics {

/// Copies positions, velocities, warm starts and applied forces of all joints, motion-capture
/// bodies and actuators that both models have, by name (joints without a name: by the name of their
/// body).
void carryState(const mjModel& from, const mjData& from_data, const mjModel& to, mjData* to_data);

}  // namespace franka_sim::physics
