// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <vector>

#include "physics/contacts/collision_scope.h"
#include "physics/joints/hold_limits.h"
#include "physics/joints/joint_frictions.h"
#include "physics/stepping/equality_solver.h"
#include "physics/stepping/step_fault.h"

namespace franka_sim::physics {

/// Computes in advance the half of a physics step that depends on positions and velocities alone:
/// while a client works on its answer the simulator is idle.
///
/// Results are the same to the last bit with and without preparation: it is used only if positions,
/// velocities, holds, gravity and the length of the step have not changed since. Called by one
/// thread at a time; while it prepares, others may read positions and velocities of joints with one
/// degree of freedom. Throws nothing but EngineError. Real-time safe.
/// Exception: `fit`.
class StepPreparation {
 public:
  /// Call for a new model, or one whose state was overwritten.
  void fit(const mjModel& model);
  /// Discards the preparation.
  void drop() noexcept { ready_ = false; }
  /// Does not change positions and velocities; contacts become those of the next step.
  void prepare(mjModel* model, mjData* data, CollisionScope& collisions);
  /// One physics step with friction in the joints and limited holds, or the fault that prevents it:
  /// then time, positions and velocities are unchanged.
  std::optional<StepFault> step(mjModel* model, mjData* data, CollisionScope& collisions,
                                JointFrictions& frictions, HoldLimits& hold_limits);

 private:
  bool isFor(const mjModel& model, const mjData& data) const noexcept;
  std::optional<StepFault> finishStep(const mjModel& model, mjData* data, HoldLimits& hold_limits);

  EqualitySolver solver_;
  bool ready_{false};
  // Inputs of the preparation.
  std::vector<double> qpos_, qvel_, eq_data_, gravity_;
  std::vector<unsigned char> eq_active_;
  double timestep_{0};
};

}  // namespace franka_sim::physics
