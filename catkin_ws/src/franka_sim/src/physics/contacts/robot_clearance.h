// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <cstddef>
#include <vector>

#include "physics/contacts/ownership.h"

namespace franka_sim::physics {

/// Leaves collisions of robots out of physics steps while none is possible (decision 56).
///
/// Periodically it checks with enlarged margins whether any robot is near another body or another
/// of its own links. If none is, no contact is possible until the joints have turned far enough to
/// move a point of the robot by that margin. The margins are 3 mm to 5 cm; the widest free one is
/// used. Steps of the same length have the same results to the last bit with and without it.
///
/// Called by the stepping thread; allocates only in `fit` and when its state is stored.
class RobotClearance {
 public:
  /// Call for a new model. @param owners outlives the clearance
  void fit(const mjModel& model, const Ownership& owners);
  /// The state that decides about the next ticks.
  struct State {
    bool clear{false};          ///< no robot can touch anything
    bool objects_clear{false};  ///< no robot can touch an object that can move
    bool decided{false};        ///< for the next tick
    int until_check{0};         ///< ticks
    // Of the last check:
    std::size_t margin{0};    ///< index of the margin that was free
    double way{0.0};          ///< that robots may move until one can touch something [m]
    double objects_way{0.0};  ///< or an object that can move [m]
    std::vector<double> checked_qpos;
  };
  const State& state() const noexcept { return state_; }
  /// @param state of the same model
  void restore(const State& state) { state_ = state; }
  /// The state of the world was changed from outside.
  void disturb() noexcept {
    state_.until_check = 0;
    state_.clear = false;
    state_.objects_clear = false;
    state_.decided = false;
  }
  /// For comparisons: if false, every step searches for all collisions.
  void use(bool used) noexcept {
    used_ = used;
    disturb();
  }
  /// Decides whether robots take part in the tick that begins, unless that is decided already.
  /// Changes the model within the call only; contacts in the data become invalid. Real-time safe.
  /// @throws EngineError within its scope
  void startTick(mjModel* model, mjData* data);
  void finishTick() noexcept { state_.decided = false; }
  /// Whether no robot can touch anything in the tick that was decided last. Real-time safe.
  bool isClear() const noexcept { return state_.clear; }
  /// Whether no robot can touch an object in that tick, one that can move. Real-time safe.
  bool areObjectsClear() const noexcept { return state_.objects_clear; }
  /// Largest sum of the ways of two points, each of a robot, between two states of the joints [m].
  /// @param qpos, others as in mjData. Real-time safe.
  double maxDisplacement(const double* qpos, const double* others) noexcept;

 private:
  /// The way of any point of the robot that a change of a joint can cause, at most.
  struct Joint {
    int qpos, dof;
    std::size_t robot;
    double reach;  ///< [m/rad], 1 for a joint that slides
  };
  class Margins;
  class Scan;

  void fitJoints(const mjModel& model);
  template <typename Change>
  double largestSum(const Change& change) noexcept;
  void updateClear(double way, const mjData& data) noexcept;
  void check(mjModel* model, mjData* data);

  bool used_{true};
  bool possible_{false};  ///< there are robots, all with joints of one degree of freedom
  State state_;
  std::vector<Joint> joints_;
  const Ownership* owners_{nullptr};
  std::vector<int> robot_geoms_, robot_pairs_;
  std::vector<bool> is_of_object_;  ///< per geom
  std::vector<double> kept_qpos_;
  std::vector<mjContact> kept_contacts_;
  std::vector<double> travel_;                       ///< per robot
  std::vector<double> geom_margins_, pair_margins_;  ///< of the unchanged model
};

}  // namespace franka_sim::physics
