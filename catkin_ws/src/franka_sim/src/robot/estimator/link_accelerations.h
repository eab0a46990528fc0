// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>

namespace franka_sim {

/// Readings of accelerometers on both sides of joints 1 to 6 [m/s^2].
struct LinkAccelerations {
  std::array<std::array<double, 3>, 6> top{}, bottom{};
};

/// Readings of accelerometers at the joints' origins: acceleration minus gravity, so that a sensor
/// at rest reads 9.81 upwards. The real positions and axes are not published; here the lower sensor
/// of joint i sits on link i - 1 and the upper one on link i, both at the joint's origin and in the
/// axes of their link's frame. Real-time safe.
/// @param q, dq, ddq [rad, rad/s, rad/s^2] @param gravity_earth in O [m/s^2]
LinkAccelerations linkAccelerations(const franka_core::ArmModel& model,
                                    const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                    const std::array<double, 7>& ddq,
                                    const std::array<double, 3>& gravity_earth) noexcept;

}  // namespace franka_sim
