// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/interface_rules.h>

#include <array>
#include <cstddef>
#include <string>

namespace franka_sim {

/// The cause of a collision reflex: the joint or axis that was farthest beyond its upper threshold
/// in the tick of the reflex.
struct Collision {
  bool happened{false};   ///< whether there was one
  std::size_t index{0};   ///< of the joint, or of x, y, z, R, P, Y
  double value{0.0};      ///< external torque [Nm] or force [N], not filtered
  double threshold{0.0};  ///< the upper one in effect [Nm, N]
};

/// The entry farthest beyond its threshold by ratio. Real-time safe.
template <std::size_t N>
Collision worstOf(const std::array<double, N>& values, const std::array<double, N>& upper) noexcept;

/// "joint 4: external torque 23.4 Nm, upper threshold 20 Nm". Not real-time safe.
std::string describeJointCollision(const Collision& collision);
/// "along z of O: external force -25.1 N, upper threshold 20 N", or about it, or of K.
/// Not real-time safe.
std::string describeCartesianCollision(const Collision& collision, InterfaceRules rules);

}  // namespace franka_sim
