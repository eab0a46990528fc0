// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/stepping/step_preparation.h"

#include <algorithm>
#include <cmath>

#include "physics/engine/rotations.h"
#include "physics/stepping/step_fault.h"

namespace franka_sim::physics {

namespace {

template <typename T>
void keep(std::vector<T>& values, const T* from) noexcept {
  std::copy_n(from, values.size(), values.begin());
}

// Compares numbers, not bits: zeros of either sign have the same effect.
template <typename T>
bool same(const std::vector<T>& values, const T* others) noexcept {
  return std::equal(values.begin(), values.end(), others);
}

std::optional<StepFault> findFault(const mjtNum* values, int count,
                                   StepFault::Where where) noexcept {
  for (int i = 0; i < count; ++i) {
    if (!(std::abs(values[i]) <= mjMAXVAL)) {
      return StepFault{where, i, values[i]};
    }
  }
  return std::nullopt;
}

std::optional<StepFault> findFault(const mjModel& model, const mjData& data) noexcept {
  const auto position = findFault(data.qpos, model.nq, StepFault::Where::kPosition);
  return position ? position : findFault(data.qvel, model.nv, StepFault::Where::kVelocity);
}

}  // namespace

// Like mj_step2, but without the reset of a world with wrong accelerations. Merged models use the
// Euler integrator.
std::optional<StepFault> StepPreparation::finishStep(const mjModel& model, mjData* data,
                                                     HoldLimits& hold_limits) {
  mj_fwdActuation(&model, data);
  mj_fwdAcceleration(&model, data);
  hold_limits.limitReturn(model, data);
  solver_.solve(model, data);
  while (hold_limits.replaceExceeded(model, data)) {
    solver_.solve(model, data);
  }
  mj_sensorAcc(&model, data);
  if (const auto fault = findFault(data->qacc, model.nv, StepFault::Where::kAcceleration)) {
    return fault;
  }
  mj_Euler(&model, data);
  return std::nullopt;
}

void StepPreparation::fit(const mjModel& model) {
  solver_.fit(model);
  ready_ = false;
  qpos_.resize(model.nq);
  qvel_.resize(model.nv);
  eq_data_.resize(mjNEQDATA * model.neq);
  eq_active_.resize(model.neq);
  gravity_.resize(3);
}

bool StepPreparation::isFor(const mjModel& model, const mjData& data) const noexcept {
  return ready_ && same(qpos_, data.qpos) && same(qvel_, data.qvel) &&
         same(eq_data_, model.eq_data) && same(eq_active_, model.eq_active) &&
         same(gravity_, model.opt.gravity) && timestep_ == model.opt.timestep;
}

void StepPreparation::prepare(mjModel* model, mjData* data, CollisionScope& collisions) {
  if (isFor(*model, *data) || findFault(*model, *data)) {
    return;
  }
  keep(qpos_, data->qpos);
  keep(qvel_, data->qvel);
  keep(eq_data_, model->eq_data);
  keep(eq_active_, model->eq_active);
  keep(gravity_, model->opt.gravity);
  timestep_ = model->opt.timestep;
  collisions.firstHalf(model, data);
  // The preparation is not visible until the step.
  copyQuaternions(*model, qpos_.data(), data->qpos);
  ready_ = true;
}

std::optional<StepFault> StepPreparation::step(mjModel* model, mjData* data,
                                               CollisionScope& collisions,
                                               JointFrictions& frictions, HoldLimits& hold_limits) {
  if (isFor(*model, *data)) {
    mj_normalizeQuat(model, data->qpos);
  } else {
    if (const auto fault = findFault(*model, *data)) {
      return fault;
    }
    collisions.firstHalf(model, data);
  }
  ready_ = false;
  frictions.apply(*model, data);
  return finishStep(*model, data, hold_limits);
}

}  // namespace franka_sim::physics
