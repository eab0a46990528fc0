// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>

namespace franka_sim::physics {

constexpr double kDegree = 3.14159265358979323846 / 180;  ///< [rad]

/// Copies the quaternions of positions: all that mj_kinematics and mj_step1 change in qpos, by
/// making them unit quaternions. Whatever else is there may be read meanwhile. Real-time safe.
inline void copyQuaternions(const mjModel& model, const double* from, double* to) noexcept {
  for (int joint = 0; joint < model.njnt; ++joint) {
    const int type = model.jnt_type[joint];
    if (type == mjJNT_FREE || type == mjJNT_BALL) {
      const int first = model.jnt_qposadr[joint] + (type == mjJNT_FREE ? 3 : 0);
      std::copy_n(from + first, 4, to + first);
    }
  }
}

}  // namespace franka_sim::physics
