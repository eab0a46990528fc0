// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "physics/contacts/ownership.h"

namespace franka_sim::physics {

/// Which bodies take part in the search for collisions. The search is left out altogether if
/// nothing remains that could touch something.
///
/// Owned by the stepping thread; allocates only in `fit`.
class CollisionScope {
 public:
  /// Call for a new model.
  void fit(const mjModel& model, const Ownership& owners);
  /// Decides about the next first halves. Real-time safe.
  void leaveOut(bool robots, bool objects) noexcept {
    without_robots_ = robots;
    without_objects_ = objects;
  }
  /// mj_step1. The model is changed within the call only. Real-time safe.
  /// @throws EngineError within its scope
  void firstHalf(mjModel* model, mjData* data);

 private:
  class Masks;

  bool without_robots_{false}, without_objects_{false};
  bool only_robots_move_{false};
  bool all_pairs_are_of_robots_{false};
  std::vector<int> robot_geoms_, object_geoms_;
  std::vector<int> contypes_, conaffinities_;  ///< of the unchanged model
};

}  // namespace franka_sim::physics
