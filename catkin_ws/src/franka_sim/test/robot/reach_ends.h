// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>

#include <cstddef>
#include <vector>

namespace franka_sim::test {

/// The last position that a joint reaches in one direction, and one beyond it within its limits.
struct End {
  std::size_t joint;
  double last, dead;
};

inline std::vector<End> endsOf(const franka_core::MotionLimits& limits) {
  std::vector<End> ends;
  for (std::size_t i = 0; i < 7; i++) {
    const franka_core::JointRange reach = limits.reach(i);
    ends.push_back({i, reach.highest, 0.5 * (reach.highest + limits.arm.q_max[i])});
    ends.push_back({i, reach.lowest, 0.5 * (reach.lowest + limits.arm.q_min[i])});
  }
  return ends;
}

}  // namespace franka_sim::test
