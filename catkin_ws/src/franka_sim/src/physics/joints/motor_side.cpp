// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/motor_side.h"

#include <algorithm>
#include <utility>

namespace franka_sim::physics {

void MotorSide::prepare(const mjModel& model, std::vector<int> brake_dofs) {
  torque_.assign(model.nv, 0.0);
  sum_.assign(model.nv, 0.0);
  velocity_.assign(model.nv, 0.0);
  brake_dofs_ = std::move(brake_dofs);
}

void MotorSide::startTick(const mjModel& model, const mjData& data) noexcept {
  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::copy(data.qvel, data.qvel + model.nv, velocity_.begin());
}

void MotorSide::addSubstep(const mjModel& model, const mjData& data,
                           const JointFrictions& frictions) noexcept {
  // The Euler step treats damping implicitly, with the velocity after the step.
  for (int dof = 0; dof < model.nv; ++dof) {
    sum_[dof] += data.qfrc_applied[dof] - model.dof_damping[dof] * data.qvel[dof];
  }
  // Rows are ordered: equality, dry friction, others; the relevant ones act on one dof with factor
  // 1.
  for (int row = 0; row < data.ne + data.nf; ++row) {
    const int id = data.efc_id[row];
    if (data.efc_type[row] == mjCNSTR_FRICTION_DOF) {
      sum_[id] += data.efc_force[row];
    } else if (data.efc_type[row] == mjCNSTR_EQUALITY && brake_dofs_[id] >= 0) {
      sum_[brake_dofs_[id]] += data.efc_force[row];
    }
  }
  for (const JointFrictions::Joint& joint : frictions.joints()) {
    sum_[joint.dof] -= joint.motor_side;
  }
}

void MotorSide::finishTick(const mjModel& model, const mjData& data, int substeps,
                           double period) noexcept {
  substeps_ = substeps;
  for (int dof = 0; dof < model.nv; ++dof) {
    torque_[dof] =
        sum_[dof] / substeps - model.dof_armature[dof] * (data.qvel[dof] - velocity_[dof]) / period;
  }
}

void MotorSide::reset(const mjData& data) noexcept {
  std::copy(data.qfrc_applied, data.qfrc_applied + torque_.size(), torque_.begin());
}

}  // namespace franka_sim::physics
