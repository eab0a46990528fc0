// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <vector>

#include "physics/joint_friction.h"

namespace franka_sim::physics {

/// A number that is not finite, or beyond MuJoCo's range. MuJoCo itself would reset the whole world
/// and go on (2.2 has no option against that), so it is checked before MuJoCo does.
struct StepFault {
  enum class Where { kPosition, kVelocity, kAcceleration };
  Where where;
  int index;  ///< in qpos or qvel
  double value;
};

/// Computes in advance the half of a physics step that depends on positions and velocities alone:
/// while a client works on its answer the simulator is idle.
///
/// Results are the same to the last bit with and without preparation: it is used only if positions,
/// velocities, holds and gravity have not changed since. After `fit` nothing allocates or throws.
/// One thread at a time.
class StepPreparation {
 public:
  /// Call for a new model, or one whose state was overwritten.
  void fit(const mjModel& model);
  /// Discards the preparation.
  void drop() noexcept { ready_ = false; }
  /// Does not change positions and velocities; contacts become those of the next step.
  void prepare(const mjModel& model, mjData* data) noexcept;
  /// One physics step with friction in the joints, or the fault that prevents it: then time,
  /// positions and velocities are unchanged.
  std::optional<StepFault> step(const mjModel& model, mjData* data,
                                JointFrictions& frictions) noexcept;

 private:
  bool isFor(const mjModel& model, const mjData& data) const noexcept;

  bool ready_{false};
  // Inputs of the preparation.
  std::vector<double> qpos_, qvel_, eq_data_, gravity_;
  std::vector<unsigned char> eq_active_;
  std::vector<double> unit_qpos_;  ///< qpos with its quaternions made unit ones, as a step does
};

}  // namespace franka_sim::physics
