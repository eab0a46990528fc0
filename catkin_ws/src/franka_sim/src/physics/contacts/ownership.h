// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <cmath>
#include <utility>
#include <vector>

namespace franka_sim::physics {

/// Which parts of a merged model belong to which robot.
struct Ownership {
  /// An object below these velocities is at rest [m/s], [rad/s]. Chosen here: objects on a table
  /// creep less.
  static constexpr double kRests = 1e-3;

  std::vector<int> robot_of_body;  ///< per MuJoCo body, -1: an object's, or the world's
  std::vector<int> robot_of_geom;  ///< the same per geom
  std::vector<int> object_dofs;    ///< degrees of freedom of objects

  Ownership() = default;
  Ownership(const mjModel& model, std::vector<int> of_body) : robot_of_body(std::move(of_body)) {
    for (int geom = 0; geom < model.ngeom; ++geom) {
      robot_of_geom.push_back(robot_of_body[model.geom_bodyid[geom]]);
    }
    for (int dof = 0; dof < model.nv; ++dof) {
      if (robot_of_body[model.dof_bodyid[dof]] < 0) {
        object_dofs.push_back(dof);
      }
    }
  }

  /// Whether a geom belongs to an object that can move.
  bool isOfObject(const mjModel& model, int geom) const noexcept {
    return robot_of_geom[geom] < 0 && model.body_weldid[model.geom_bodyid[geom]] != 0;
  }
  bool isPairOfRobot(const mjModel& model, int pair) const noexcept {
    return robot_of_geom[model.pair_geom1[pair]] >= 0 || robot_of_geom[model.pair_geom2[pair]] >= 0;
  }

  /// Real-time safe.
  bool objectsRest(const mjData& data) const noexcept {
    for (const int dof : object_dofs) {
      if (!(std::abs(data.qvel[dof]) < kRests)) {
        return false;
      }
    }
    return true;
  }
};

}  // namespace franka_sim::physics
