// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/hold_limits.h"

#include <algorithm>
#include <cmath>

namespace franka_sim::physics {

namespace {

/// Share of the effort that remains for braking (see the class).
constexpr double kBraking = 0.5;
/// The least of it, for joints that can hardly hold their load. Chosen here.
constexpr double kMinBraking = 0.05;
/// Beyond the maximum velocity by rounding.
constexpr double kRounding = 1.0 + 1e-6;

/// Weight of a row that was replaced: MuJoCo itself gives no row the weight 0.
constexpr double kReplaced = 0.0;
/// Its inverse, for solvers that divide by it. Chosen here: no effort remains.
constexpr double kInverse = 1e30;

/// Takes all effect from a row of the constraints.
void disable(const mjModel& model, mjData* data, int row) noexcept {
  data->efc_D[row] = kReplaced;
  data->efc_R[row] = kInverse;
  if (mj_isDual(&model) == 0) {
    return;
  }
  if (mj_isSparse(&model) == 0) {
    data->efc_AR[row * data->nefc + row] = kInverse;
    return;
  }
  const int first = data->efc_AR_rowadr[row];
  for (int i = first; i < first + data->efc_AR_rownnz[row]; ++i) {
    if (data->efc_AR_colind[i] == row) {
      data->efc_AR[i] = kInverse;
    }
  }
}

int dofOf(const mjModel& model, int equality) noexcept {
  return model.jnt_dofadr[model.eq_obj1id[equality]];
}

/// The acceleration with which a joint can surely brake [rad/s^2] or [m/s^2].
double braking(const mjModel& model, const mjData& data, int dof, double max_effort) noexcept {
  const double inertia = data.qM[model.dof_Madr[dof]];
  const double rest = max_effort - std::abs(data.qfrc_smooth[dof]);
  return std::max(kBraking * rest, kMinBraking * max_effort) / inertia;
}

}  // namespace

void HoldLimits::fit(const mjModel& model) {
  holds_.assign(model.neq, Hold());
  replacement_.assign(model.neq, 0.0);
  limited_ = 0;
}

bool HoldLimits::isLimited(int equality) const noexcept {
  return std::isfinite(holds_[equality].max_effort);
}

void HoldLimits::set(int equality, const Hold& hold) noexcept {
  limited_ -= isLimited(equality) ? 1 : 0;
  holds_[equality] = hold;
  limited_ += isLimited(equality) ? 1 : 0;
}

// The rows of equalities come first; that of a hold acts on one dof with factor 1.
void HoldLimits::limitReturn(const mjModel& model, mjData* data) noexcept {
  for (int row = 0; limited_ > 0 && row < data->ne; ++row) {
    const int equality = data->efc_id[row];
    if (!isLimited(equality)) {
      continue;
    }
    // MuJoCo's law: a_ref = damping (e / lag - v).
    const Hold& hold = holds_[equality];
    const double* const kbip = data->efc_KBIP + 4 * row;
    const double damping = kbip[1];
    const double lag = damping / (kbip[0] * kbip[2]);
    const double error = -data->efc_pos[row];
    const double behind = error - lag * hold.velocity;
    const double braked = braking(model, *data, dofOf(model, equality), hold.max_effort);
    const double linear = lag * lag * braked;
    double velocity = error / lag;
    if (std::abs(behind) > linear) {
      velocity = hold.velocity +
                 std::copysign(std::sqrt(braked * (2.0 * std::abs(behind) - linear)), behind);
    }
    const double fastest = std::max(hold.max_velocity, std::abs(hold.velocity)) * kRounding;
    velocity = std::clamp(velocity, -fastest, fastest);
    if (velocity != error / lag) {
      data->efc_aref[row] = damping * (velocity - data->efc_vel[row]);
    }
  }
}

bool HoldLimits::replaceExceeded(const mjModel& model, mjData* data) noexcept {
  bool replaced = false;
  for (int row = 0; limited_ > 0 && row < data->ne; ++row) {
    const int equality = data->efc_id[row];
    if (!isLimited(equality)) {
      continue;
    }
    const double max_effort = holds_[equality].max_effort;
    double& force = data->efc_force[row];
    if (data->efc_D[row] == kReplaced) {
      force = replacement_[equality];
    } else if (std::abs(force) > max_effort) {
      replacement_[equality] = std::copysign(max_effort, force);
      data->qfrc_smooth[dofOf(model, equality)] += replacement_[equality];
      disable(model, data, row);
      replaced = true;
    }
  }
  if (replaced) {
    mj_solveM(&model, data, data->qacc_smooth, data->qfrc_smooth, 1);
  }
  return replaced;
}

}  // namespace franka_sim::physics
