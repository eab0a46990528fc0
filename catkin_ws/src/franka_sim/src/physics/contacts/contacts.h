// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <array>
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

/// The shorter physics step: half a millisecond holds a grasp, a whole one loses it (decision 58).
constexpr const char* kTimestep = "0.0005";
/// Larger values reduce the creep of a grasp; 100 holds for a minute.
constexpr const char* kImpratio = "100";
/// Between finger pad and graspable object: time constant of two steps, as stiff as is stable.
constexpr const char* kGraspSolref = "0.001 1";
constexpr const char* kGraspSolimp = "0.95 0.99 0.001 0.5 2";
/// Everything else: soft enough that an impact at 0.1 m/s peaks at 63 N, not 655 N.
constexpr const char* kContactSolref = "0.01 1";
constexpr const char* kContactSolimp = "0.9 0.95 0.001 0.5 2";
/// Joint stops, coupled fingers, brakes.
constexpr const char* kStopSolref = "0.004 1";
constexpr const char* kCouplingSolref = "0.002 1";
constexpr const char* kBrakeSolref = "0.002 1";
constexpr const char* kStiffSolimp = "0.9999 0.9999 0.001 0.5 2";
/// Normal and tangential friction; a grasp needs torsional friction too.
constexpr const char* kCondim = "3";
constexpr const char* kGraspCondim = "4";
constexpr double kTorsionalFriction = 0.005;  ///< MuJoCo's default [m]
constexpr double kRollingFriction = 0.0001;   ///< MuJoCo's default [m]
/// Rubber of the fingers, and any other link, if the URDF gives none (the fingers' value is that of
/// the robot description, the other Gazebo's default).
constexpr double kFingerFriction = 1.13;
constexpr double kLinkFriction = 1.0;

}  // namespace franka_sim::physics

namespace franka_sim {

/// A contact in a step, with the force that acted on the second geom.
struct GeomContact {
  int geom1, geom2;
  std::array<double, 3> position, force;  ///< world axes [m] [N]
};

}  // namespace franka_sim

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

/// mj_step1. If there are more constraints than the model has room for, the contacts of each pair
/// of shapes share their friction: two of them get all of it, the others only press. Allocates
/// nothing.
void firstHalf(const mjModel* model, mjData* data);

/// mj_fwdConstraint. MuJoCo's Newton method factorizes a matrix of all objects that touch each
/// other, at a cost that grows with the cube of their number: a pile of 200 cubes takes 0.8 s a
/// step. With many contacts between objects, conjugate gradients solve the constraints instead, in
/// 0.01 to 0.06 s (docs/performance.md). It depends on the present contacts alone, so that runs
/// repeat. A model that asks for another solver keeps it. Allocates nothing.
void solveConstraints(const mjModel& model, mjData* data);

}  // namespace franka_sim::physics
