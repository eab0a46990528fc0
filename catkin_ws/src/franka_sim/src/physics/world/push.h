// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

namespace franka_sim {

/// A force at a point fixed to a body, for a number of ticks.
struct Push {
  std::string body_name;  ///< to find the body again in a recompiled model
  int body;
  Eigen::Vector3d point;          ///< MuJoCo body frame [m]
  Eigen::Vector3d force, torque;  ///< world axes [N] [Nm]
  std::uint64_t ticks_left;
  /// A push along a joint of an object, instead of at a point.
  std::string joint{};  ///< empty: none
  double effort{0};     ///< [Nm] or [N]
  int dof{-1};
};

}  // namespace franka_sim
