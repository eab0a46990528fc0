// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "physics/joints/joint_frictions.h"

namespace franka_sim::physics {

/// Reading of a torque sensor between gear and link, the mean over a tick (decision 2):
/// motor torque - friction + brake - B (dq_k - dq_{k-1}) / T, per degree of freedom [Nm] or [N].
/// The friction of JointFriction at the link side acts behind the sensor and is not subtracted.
///
/// Owned by the stepping thread; allocates only in `prepare`.
class MotorSide {
 public:
  /// Allocates for a model. @param brake_dofs for every equality the degree of freedom that it
  /// brakes, or -1 for other equalities.
  void prepare(const mjModel& model, std::vector<int> brake_dofs);
  /// Call before the first substep of a tick.
  void startTick(const mjModel& model, const mjData& data) noexcept;
  /// Call after each substep, while the constraint forces of that substep are still in the data.
  void addSubstep(const mjModel& model, const mjData& data,
                  const JointFrictions& frictions) noexcept;
  /// Call after the last substep. @param period of the tick [s].
  void finishTick(const mjModel& model, const mjData& data, int substeps, double period) noexcept;
  /// Before any motion the sensor shows the motor's torque.
  void reset(const mjData& data) noexcept;

  double torque(int dof) const noexcept { return torque_[dof]; }
  /// Physics steps of the last tick.
  int substeps() const noexcept { return substeps_; }
  void setTorque(int dof, double torque) noexcept { torque_[dof] = torque; }
  const std::vector<double>& torques() const noexcept { return torque_; }

 private:
  std::vector<double> torque_, sum_, velocity_;
  std::vector<int> brake_dofs_;
  int substeps_{1};
};

}  // namespace franka_sim::physics
