// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/stepping/equality_solver.h"

#include <cmath>

#include "physics/contacts/constraint_step.h"

namespace franka_sim::physics {

void EqualitySolver::fit(const mjModel& model) {
  jacobian_rows_.assign(kMaxRows * model.nv, 0.0);
  solved_rows_.assign(kMaxRows * model.nv, 0.0);
}

bool EqualitySolver::handles(const mjData& data) const noexcept {
  return data.nefc > 0 && data.nefc <= kMaxRows && data.nefc == data.ne;
}

// The rows, and the matrix that is to be factorized.
void EqualitySolver::multiply(const mjModel& model, mjData* data) {
  const int rows = data->nefc;
  Row unit{};
  for (int i = 0; i < rows; ++i) {
    unit.fill(0.0);
    unit[i] = 1.0;
    double* jacobian = &jacobian_rows_[i * model.nv];
    mj_mulJacTVec(&model, data, jacobian, unit.data());
    mju_copy(&solved_rows_[i * model.nv], jacobian, model.nv);
  }
  mj_solveM(&model, data, solved_rows_.data(), solved_rows_.data(), rows);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j <= i; ++j) {
      factor_[i][j] = mju_dot(&jacobian_rows_[i * model.nv], &solved_rows_[j * model.nv], model.nv);
    }
    factor_[i][i] += data->efc_R[i];
  }
}

bool EqualitySolver::factorize(const mjData& data) noexcept {
  for (int i = 0; i < data.nefc; ++i) {
    for (int j = 0; j <= i; ++j) {
      double value = factor_[i][j];
      for (int k = 0; k < j; ++k) {
        value -= factor_[i][k] * factor_[j][k];
      }
      if (i != j) {
        factor_[i][j] = value / factor_[j][j];
      } else if (value > 0.0) {
        factor_[i][i] = std::sqrt(value);
      } else {
        return false;
      }
    }
  }
  return true;
}

void EqualitySolver::solve(const mjModel& model, mjData* data) {
  if (!handles(*data)) {
    solveConstraints(model, data);
    return;
  }
  multiply(model, data);
  if (!factorize(*data)) {  // of numbers that are not finite
    mj_fwdConstraint(&model, data);
    return;
  }
  const int rows = data->nefc;
  double* force = data->efc_force;
  for (int i = 0; i < rows; ++i) {
    force[i] =
        data->efc_aref[i] - mju_dot(&jacobian_rows_[i * model.nv], data->qacc_smooth, model.nv);
    for (int k = 0; k < i; ++k) {
      force[i] -= factor_[i][k] * force[k];
    }
    force[i] /= factor_[i][i];
  }
  for (int i = rows - 1; i >= 0; --i) {
    for (int k = i + 1; k < rows; ++k) {
      force[i] -= factor_[k][i] * force[k];
    }
    force[i] /= factor_[i][i];
  }
  mju_copy(data->qacc, data->qacc_smooth, model.nv);
  mju_zero(data->qfrc_constraint, model.nv);
  for (int i = 0; i < rows; ++i) {
    mju_addToScl(data->qacc, &solved_rows_[i * model.nv], force[i], model.nv);
    mju_addToScl(data->qfrc_constraint, &jacobian_rows_[i * model.nv], force[i], model.nv);
    data->efc_state[i] = mjCNSTRSTATE_QUADRATIC;
  }
  mju_copy(data->qacc_warmstart, data->qacc, model.nv);
  data->solver_iter = 0;
}

}  // namespace franka_sim::physics
