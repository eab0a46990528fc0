// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

namespace franka_sim::physics {

/// Attributes of MJCF's <size> that the world's file sets: they are kept.
struct GivenSizes {
  bool nconmax{false}, njmax{false}, nstack{false};
};

/// Gives a compiled model room for the contacts and constraints of all its shapes that move and
/// collide. MuJoCo's default is 100 contacts, which 25 boxes on a table use up.
/// @param robot_of_body per body the index of its robot, or -1
void setContactCapacity(mjModel* model, const std::vector<int>& robot_of_body,
                        const GivenSizes& given);

}  // namespace franka_sim::physics
