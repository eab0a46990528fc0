// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/virtual_walls.h"

#include <franka_core/transform.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace franka_sim {

using franka_core::fci::CartesianLimit;

namespace {

constexpr double kDepthJitter = 1e-4;  // [m], chosen here: allowed growth of the depth at rest

}  // namespace

bool VirtualWalls::set(std::int32_t id, const CartesianLimit& wall) noexcept {
  const bool sensible =
      std::all_of(wall.object_world_size.begin(), wall.object_world_size.end(),
                  [](double edge) { return std::isfinite(edge) && edge >= 0.0; }) &&
      franka_core::isRigidTransform(wall.object_frame);
  if (get(id) == nullptr || !sensible) {
    return false;
  }
  walls_[static_cast<std::size_t>(id)] = wall;
  return true;
}

const CartesianLimit* VirtualWalls::get(std::int32_t id) const noexcept {
  return id >= 0 && static_cast<std::size_t>(id) < kCount ? &walls_[static_cast<std::size_t>(id)]
                                                          : nullptr;
}

// Depth inside; 0 or less outside.
double VirtualWalls::depth(const CartesianLimit& wall,
                           const std::array<double, 16>& O_T_EE) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> frame(wall.object_frame.data());
  const Eigen::Vector3d away(O_T_EE[12] - frame(0, 3), O_T_EE[13] - frame(1, 3),
                             O_T_EE[14] - frame(2, 3));
  const Eigen::Vector3d inside = frame.topLeftCorner<3, 3>().transpose() * away;
  double depth = 0.5 * wall.object_world_size[0] - std::abs(inside[0]);
  for (int i = 1; i < 3; i++) {
    depth = std::min(
        depth, 0.5 * wall.object_world_size[static_cast<std::size_t>(i)] - std::abs(inside[i]));
  }
  return depth;
}

void VirtualWalls::begin(const std::array<double, 16>& O_T_EE) noexcept {
  for (std::size_t i = 0; i < kCount; i++) {
    allowed_[i] = walls_[i].active ? std::max(0.0, depth(walls_[i], O_T_EE) + kDepthJitter) : 0.0;
  }
}

bool VirtualWalls::violated(const std::array<double, 16>& O_T_EE) noexcept {
  for (std::size_t i = 0; i < kCount; i++) {
    if (!walls_[i].active) {
      continue;
    }
    const double now = depth(walls_[i], O_T_EE);
    if (now > allowed_[i]) {
      return true;
    }
    allowed_[i] = std::max(0.0, std::min(allowed_[i], now + kDepthJitter));
  }
  return false;
}

}  // namespace franka_sim
