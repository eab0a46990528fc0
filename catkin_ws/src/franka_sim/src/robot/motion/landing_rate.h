// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// The highest rate of change in this tick from which the value still stops after `distance`, if
/// the rate decreases by `step` per tick: a velocity for a position, a deceleration for a velocity.
/// @param distance, step not negative. Real-time safe.
double landingRate(double distance, double step) noexcept;

}  // namespace franka_sim
