// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <optional>
#include <vector>

namespace franka_sim::physics {

/// A number that is not finite, or beyond what MuJoCo computes with. MuJoCo itself would put the
/// whole world back to its beginning and go on (2.2 has no option against that), so that it is
/// looked for before MuJoCo does.
struct StepFault {
  enum class Where { kPosition, kVelocity, kAcceleration };
  Where where;
  int index;  ///< in qpos or qvel
  double value;
};

/// The half of a physics step that depends on positions and velocities alone, done ahead of time:
/// while a client works on its answer the simulator has nothing else to do.
///
/// What a step does is the same to the last bit, prepared or not: a preparation is used only where
/// positions, velocities, holds and gravity are still those it was made for. After `fit` nothing
/// allocates or throws. One thread at a time.
class StepPreparation {
 public:
  /// For a new model, or one whose state was written as a whole.
  void fit(const mjModel& model);
  /// Forgets what was prepared.
  void drop() noexcept { ready_ = false; }
  /// Leaves positions and velocities as they are; contacts become those of the step to come.
  void prepare(const mjModel& model, mjData* data) noexcept;
  /// One physics step, or what stands in its way: then time, positions and velocities are as they
  /// were.
  std::optional<StepFault> step(const mjModel& model, mjData* data) noexcept;

 private:
  bool isFor(const mjModel& model, const mjData& data) const noexcept;

  bool ready_{false};
  // What it was made for.
  std::vector<double> qpos_, qvel_, eq_data_, gravity_;
  std::vector<unsigned char> eq_active_;
  std::vector<double> unit_qpos_;  ///< qpos with its quaternions made unit ones, as a step does
};

}  // namespace franka_sim::physics
